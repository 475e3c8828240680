//! Converts stamps of the robot's sensors to the adapter's clock.
//!
//! The clock of a sender need not agree with the adapter's. The least difference between arrival and stamp in the last
//! seconds is taken as the offset. A message with a greater difference was delayed on its way, not stamped later.

/// Time within which delays are compared, seconds: long enough for jitter, short enough for clocks that drift.
const WINDOW_S: f64 = 5.0;
/// Step back of a stamp, seconds, above which the sender's clock counts as having been set.
const SET_BACK_S: f64 = 1.0;

/// Whether a message is neither a duplicate of the newest one nor overtaken by it; stamps in seconds of the sender's
/// clock. A stamp more than 1 s before the newest one shows that this clock was set.
pub fn is_newer(stamp_s: f64, newest_s: Option<f64>) -> bool {
    newest_s.is_none_or(|newest_s| stamp_s > newest_s || is_set_back(stamp_s, newest_s))
}

/// Whether a stamp shows that the sender's clock was set back.
pub(crate) fn is_set_back(stamp_s: f64, newest_s: f64) -> bool {
    stamp_s < newest_s - SET_BACK_S
}

/// Converts stamps of a sender to the adapter's clock.
#[derive(Debug, Clone, Default)]
#[allow(clippy::struct_field_names, reason = "a name ends with its unit")]
pub struct Clock {
    /// Start of the current window. The least differences between arrival and stamp are those in this window and in the
    /// one before.
    since_s: f64,
    least_s: Option<f64>,
    least_before_s: Option<f64>,
    newest_s: Option<f64>,
}

impl Clock {
    /// The time of a stamp on the adapter's clock, seconds: never later than the arrival. A message without a stamp
    /// (`stamp_s` is `None`) counts as stamped when it arrives.
    pub fn measured_s(&mut self, stamp_s: Option<f64>, arrival_s: f64) -> f64 {
        let Some(stamp_s) = stamp_s else { return arrival_s };
        if self.newest_s.is_some_and(|newest_s| is_set_back(stamp_s, newest_s)) {
            *self = Self::default();
        }
        self.newest_s = Some(self.newest_s.map_or(stamp_s, |newest_s| newest_s.max(stamp_s)));
        if self.least_s.is_some() && arrival_s - self.since_s > WINDOW_S {
            self.least_before_s = self.least_s.take();
        }
        if self.least_s.is_none() {
            self.since_s = arrival_s;
        }
        let delay_s = arrival_s - stamp_s;
        let least_s = self.least_s.map_or(delay_s, |least_s| least_s.min(delay_s));
        self.least_s = Some(least_s);
        stamp_s + self.least_before_s.map_or(least_s, |before_s| before_s.min(least_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_message_keeps_its_time_of_measurement() {
        let mut clock = Clock::default();
        assert_eq!(clock.measured_s(Some(1000.0), 10.0), 10.0);
        assert_eq!(clock.measured_s(Some(1000.5), 10.7), 10.5);
        assert_eq!(clock.measured_s(Some(1001.0), 11.0), 11.0);
    }

    #[test]
    fn duplicates_and_overtaken_messages_are_not_newer_and_those_after_a_restart_are() {
        let newer = |stamp_s| is_newer(stamp_s, Some(10.0));
        assert_eq!([newer(10.1), newer(10.0), newer(9.1), newer(8.9)], [true, false, false, true]);
        assert!(is_newer(3.0, None));
    }

    #[test]
    fn a_vehicle_without_stamps_measures_when_its_messages_arrive() {
        assert_eq!(Clock::default().measured_s(None, 7.0), 7.0);
    }

    #[test]
    fn a_clock_that_drifts_is_followed() {
        let mut clock = Clock::default();
        let (mut arrival_s, mut late_s) = (0.0, 0.0);
        for n in 0..1000 {
            arrival_s = 0.1 * f64::from(n);
            late_s = arrival_s - clock.measured_s(Some(arrival_s * 0.999), arrival_s);
        }
        assert!(arrival_s > 99.0 && (0.0..=0.0101).contains(&late_s), "{late_s}");
    }

    #[test]
    fn a_clock_that_was_set_back_starts_again() {
        let mut clock = Clock::default();
        clock.measured_s(Some(1000.0), 10.0);
        assert_eq!(clock.measured_s(Some(3.0), 10.5), 10.5);
        assert_eq!(clock.measured_s(Some(3.1), 10.7), 10.6);
    }
}
