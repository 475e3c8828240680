//! The clock of an instrument beside the clock of a mission.

/// Seconds in a day.
const DAY_S: f64 = 86_400.0;
/// Standard deviation of a time that is known to the whole second.
const WHOLE_SECOND_S: f64 = 0.289;

/// Converts times of a file to mission time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Clock {
    /// A time of the file, seconds, and the mission time at that moment.
    zero: (f64, f64),
    /// Mission seconds in a second of the file.
    rate: f64,
    /// Whether times are times of day, which begin again at midnight.
    is_of_day: bool,
    /// Standard deviation of a mission time, seconds.
    pub(super) sigma_s: f64,
}

/// What is known about a clock.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known<'a> {
    /// Moments by both clocks: the time of the file and the mission time, seconds; none, one or two.
    pub(super) marks: &'a [(f64, f64)],
    /// Seconds to add to the times of the file.
    pub(super) offset_s: Option<f64>,
    /// For dates and times of day: the time by that clock at which mission time was 0, to the whole second.
    pub(super) began_s: Option<f64>,
    pub(super) is_of_day: bool,
    pub(super) sigma_s: Option<f64>,
}

impl Clock {
    pub(super) fn new(known: Known<'_>) -> Result<Self, String> {
        let Known { marks, offset_s, began_s, is_of_day, sigma_s } = known;
        let exact = Self { zero: (0.0, 0.0), rate: 1.0, is_of_day, sigma_s: sigma_s.unwrap_or(0.0) };
        match (marks, offset_s) {
            ([], Some(offset_s)) => Ok(Self { zero: (began_s.unwrap_or(0.0), offset_s), ..exact }),
            ([], None) => {
                // A start that is known to the whole second was, on average, half a second later.
                let sigma_s = sigma_s.or(began_s.map(|_| WHOLE_SECOND_S)).unwrap_or(0.0);
                Ok(Self { zero: (began_s.map_or(0.0, |began_s| began_s + 0.5), 0.0), sigma_s, ..exact })
            }
            ([mark], _) => Ok(Self { zero: *mark, ..exact }),
            ([one, other], _) => {
                let rate = (other.1 - one.1) / exact.since(one.0, other.0);
                if !(0.9..=1.1).contains(&rate) {
                    let what = format!(
                        "by the two marks, {:.1} s of the file are {:.1} s of the mission; a clock is not that wrong: check \
                         the marks",
                        exact.since(one.0, other.0),
                        other.1 - one.1
                    );
                    return Err(what);
                }
                Ok(Self { zero: *one, rate, ..exact })
            }
            _ => Err("at most two marks: two give the offset and the rate of the clock".into()),
        }
    }

    /// The mission time of a time of the file, seconds.
    pub(super) fn mission_s(&self, file_s: f64) -> f64 {
        self.zero.1 + self.rate * self.since(self.zero.0, file_s)
    }

    /// Seconds that the clock of the file loses in an hour of the mission; negative if it gains.
    pub(super) fn drift_s_per_h(&self) -> f64 {
        3600.0 * (self.rate - 1.0)
    }

    /// Seconds to add to a time of the file at the zero of its marks.
    pub(super) fn offset_s(&self) -> f64 {
        self.zero.1 - self.zero.0
    }

    /// Seconds from one time of the file to another.
    fn since(&self, from_s: f64, to_s: f64) -> f64 {
        let since_s = to_s - from_s;
        if self.is_of_day && since_s < -DAY_S / 2.0 { since_s + DAY_S } else { since_s }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known(marks: &[(f64, f64)]) -> Known<'_> {
        Known { marks, offset_s: None, began_s: None, is_of_day: false, sigma_s: None }
    }

    #[test]
    fn two_marks_give_the_offset_and_a_drift_of_two_seconds_an_hour() {
        let clock = Clock::new(known(&[(1000.0, 10.0), (4598.0, 3610.0)])).unwrap();
        assert!((clock.drift_s_per_h() - 2.0).abs() < 0.01, "{}", clock.drift_s_per_h());
        assert!(
            (clock.mission_s(4598.0) - 3610.0).abs() < 1e-9 && (clock.mission_s(1000.0) - 10.0).abs() < 1e-9
        );
        assert!(Clock::new(known(&[(0.0, 0.0), (10.0, 100.0)])).is_err(), "no clock is that wrong");
        assert!(Clock::new(known(&[(0.0, 0.0), (0.0, 1.0)])).is_err(), "the same moment twice");
    }

    #[test]
    fn a_start_known_to_the_second_makes_times_uncertain_and_a_mark_does_not() {
        let by_name = Clock::new(Known { began_s: Some(500.0), ..known(&[]) }).unwrap();
        assert!((by_name.mission_s(501.0) - 0.5).abs() < 1e-9 && by_name.sigma_s > 0.28);
        let offset = Clock::new(Known { began_s: Some(500.0), offset_s: Some(-2.0), ..known(&[]) }).unwrap();
        assert!((offset.mission_s(510.0) - 8.0).abs() < 1e-9 && offset.sigma_s < 1e-9);
        let mark = Clock::new(Known { began_s: Some(500.0), ..known(&[(510.0, 12.0)]) }).unwrap();
        assert!((mark.mission_s(511.0) - 13.0).abs() < 1e-9 && mark.sigma_s < 1e-9);
    }

    #[test]
    fn times_of_day_go_on_after_midnight() {
        let clock = Clock::new(Known { is_of_day: true, ..known(&[(86_390.0, 5.0)]) }).unwrap();
        assert!((clock.mission_s(10.0) - 25.0).abs() < 1e-9);
    }
}
