//! Times with a date, as instruments write them (RFC 3339).

use jiff::{
    Timestamp,
    civil::{DateTime, Time},
};

/// An example of a valid time, for messages.
pub(crate) const EXAMPLE: &str = "2026-10-25T02:59:58.250Z";

/// The form in which a time is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Written {
    /// A number of seconds, milliseconds or microseconds.
    Number,
    /// A time of day: seconds since midnight.
    OfDay,
    /// A time with a date: seconds since 1970.
    Dated,
}

impl Written {
    /// Returns the form of the time in a cell.
    pub(crate) fn of(cell: &str) -> Self {
        match cell {
            cell if is_date(cell) => Self::Dated,
            cell if seconds_of_day(cell).is_some() => Self::OfDay,
            _ => Self::Number,
        }
    }

    /// Returns a time in the form that the file uses.
    pub(crate) fn shown(self, seconds: f64) -> String {
        match self {
            Self::Number => format!("{seconds} s"),
            Self::OfDay => written_of_day(seconds),
            Self::Dated => written(seconds),
        }
    }
}

/// Whether a cell begins with a date.
pub(crate) fn is_date(cell: &str) -> bool {
    let bytes = cell.as_bytes();
    bytes.len() >= 8 && bytes[..4].iter().all(u8::is_ascii_digit) && bytes[4] == b'-'
}

/// Returns the seconds since midnight of a time of day, such as `07:40:12.250` or `07:40:12,250`; `None` for any
/// other text.
pub(crate) fn seconds_of_day(cell: &str) -> Option<f64> {
    let time: Time = cell.replace(',', ".").parse().ok().filter(|_| cell.matches(':').count() == 2)?;
    let whole = f64::from(time.hour()) * 3600.0 + f64::from(time.minute()) * 60.0 + f64::from(time.second());
    Some(whole + f64::from(time.subsec_nanosecond()) * 1e-9)
}

/// Returns the seconds since 1970 of a time with date and zone.
pub(crate) fn seconds(cell: &str) -> Result<f64, String> {
    match cell.parse::<Timestamp>() {
        Ok(time) => Ok(time.as_second() as f64 + f64::from(time.subsec_nanosecond()) * 1e-9),
        Err(_) if cell.parse::<DateTime>().is_ok() => Err(format!(
            "`{cell}` has no time zone; append Z for UTC, or the offset from UTC, such as +01:00"
        )),
        Err(_) => Err(format!("`{cell}` is not a time; write date, time and zone, such as {EXAMPLE}")),
    }
}

/// Returns a time in seconds from any form that readings may use: a number, a time of day, or a date.
pub(crate) fn time_s(cell: &str, has_commas: bool) -> Result<f64, String> {
    if is_date(cell) {
        return seconds(cell);
    }
    let number = if has_commas { cell.replace(',', ".").parse() } else { cell.parse() };
    let number = number.ok().filter(|number: &f64| number.is_finite());
    seconds_of_day(cell).or(number).ok_or_else(|| {
        format!("`{cell}` is not a time; write seconds, a time of day (07:40:12.250), or a date ({EXAMPLE})")
    })
}

/// Returns seconds since midnight as a time of day.
fn written_of_day(seconds: f64) -> String {
    let ms = (seconds * 1e3).round() as i64;
    let (hours, minutes, rest) = (ms / 3_600_000, ms / 60_000 % 60, ms % 60_000);
    format!("{hours:02}:{minutes:02}:{:02}.{:03}", rest / 1000, rest % 1000)
}

/// Returns seconds since 1970 as a UTC time.
pub(crate) fn written(seconds: f64) -> String {
    let time = Timestamp::from_millisecond((seconds * 1e3).round() as i64);
    time.map_or_else(|_| format!("{seconds} s"), |time| time.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_every_zone_are_one_time() {
        for text in [
            "2026-10-25T02:59:58.250Z",
            "2026-10-25T03:59:58.250+01:00",
            "2026-10-25 02:59:58.250Z",
            "2026-10-24T21:29:58,25-05:30",
        ] {
            assert!(is_date(text));
            assert_eq!(seconds(text), Ok(1_792_897_198.25), "{text}");
        }
        assert_eq!(written(1_792_897_198.25), "2026-10-25T02:59:58.25Z");
    }

    #[test]
    fn times_of_day_are_seconds_since_midnight() {
        assert_eq!(seconds_of_day("07:40:12,250"), Some(27_612.25));
        assert_eq!(seconds_of_day("00:00:00"), Some(0.0));
        assert_eq!(written_of_day(86_399.9), "23:59:59.900");
        for text in ["7.5", "07:40", "25:00:00", "2026-10-25T02:59:58Z", ""] {
            assert_eq!(seconds_of_day(text), None, "{text}");
        }
    }

    #[test]
    fn a_time_without_a_zone_is_refused_with_what_to_add() {
        assert!(seconds("2026-10-25T02:59:58").unwrap_err().contains("append Z"));
        assert!(seconds("2026-13-25T02:59:58Z").unwrap_err().contains("is not a time"));
        assert!(!is_date("12.5") && !is_date("-3") && !is_date("2026.5"));
    }
}
