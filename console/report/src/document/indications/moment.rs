//! Times of day, and their offset from the start of a run.

use jiff::{Timestamp, civil};

/// Seconds in a day.
const DAY_S: f64 = 86_400.0;

/// A time of day.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Clock {
    /// A time with a date.
    Moment(Timestamp),
    /// A time of day without a date, UTC.
    Time(civil::Time),
}

impl Clock {
    /// Reads `2026-11-24T07:40:12.5Z` with any zone (UTC if there is none), or `07:40:12.5`; returns `None` for
    /// anything else.
    pub(super) fn read(text: &str) -> Option<Self> {
        let moment = || {
            text.parse::<Timestamp>().ok().or_else(|| {
                let local: civil::DateTime = text.parse().ok().filter(|_| text.contains(':'))?;
                local.to_zoned(jiff::tz::TimeZone::UTC).ok().map(|zoned| zoned.timestamp())
            })
        };
        let is_date = text.len() > 10 && text.as_bytes()[..4].iter().all(u8::is_ascii_digit);
        if is_date { moment().map(Self::Moment) } else { text.parse().ok().map(Self::Time) }
    }

    /// Seconds after the start of a run; a time without a date means its first occurrence after the start.
    pub(super) fn after_s(self, began: Timestamp) -> f64 {
        match self {
            Self::Moment(moment) => moment.duration_since(began).as_secs_f64(),
            Self::Time(time) => {
                let zero = began.to_zoned(jiff::tz::TimeZone::UTC).time();
                let since = time.duration_since(zero).as_secs_f64();
                if since < 0.0 { since + DAY_S } else { since }
            }
        }
    }
}

/// The start of a run, read from its folder name: `20261122T040132Z-...`.
pub(in crate::document) fn began(name: &str) -> Option<Timestamp> {
    let stamp = name.split('-').next()?;
    let at = |range: std::ops::Range<usize>| stamp.get(range);
    let is_stamp = stamp.len() == 16 && stamp.as_bytes()[8] == b'T' && stamp.ends_with('Z');
    let text =
        format!("{}-{}-{}T{}:{}:{}Z", at(0..4)?, at(4..6)?, at(6..8)?, at(9..11)?, at(11..13)?, at(13..15)?);
    text.parse().ok().filter(|_| is_stamp)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::float_cmp, reason = "tests")]

    use super::*;

    #[test]
    fn a_time_of_day_is_so_long_after_the_beginning_of_the_run() {
        let began = began("20261122T235950Z-demo-rpf-1").unwrap();
        let after = |text: &str| Clock::read(text).map(|clock| clock.after_s(began));
        assert_eq!(after("2026-11-22T23:59:52.5Z"), Some(2.5));
        assert_eq!(after("2026-11-23T01:00:10+01:00"), Some(20.0));
        assert_eq!(after("2026-11-23 00:00:10"), Some(20.0));
        assert_eq!((after("23:59:51"), after("00:00:10")), (Some(1.0), Some(20.0)));
        assert_eq!((after("soon"), after("25:00:00"), after("2026-11-22")), (None, None, None));
        assert_eq!(super::began("demo"), None);
    }
}
