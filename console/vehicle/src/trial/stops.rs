//! Time and distance of a stop, from samples of the motion before and after its cause.

use super::{Figure, Row, Verdict};

/// A vehicle that moves no faster than this counts as standing still, metres per second and radians per second.
const STANDS_M_PER_S: f64 = 0.005;
const STANDS_RAD_PER_S: f64 = 0.02;
/// The speed at the cause of a stop is the mean over this time, seconds.
const BEFORE_S: f64 = 0.3;
/// A stop counts as measured if the vehicle had at least this share of the commanded speed.
const FAST_ENOUGH: f64 = 0.5;
/// Time between two samples, seconds, above which a stop counts as not measured.
const GAP_S: f64 = 0.3;
/// A vehicle that has stood still for this long counts as stopped, seconds.
pub const QUIET_S: f64 = 0.3;

/// A motion between two times of the vehicle's clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// The end of the motion, seconds of the vehicle's clock.
    pub t_s: f64,
    /// Its duration, seconds.
    pub over_s: f64,
    /// Distance, metres, in any direction.
    pub way_m: f64,
    /// Change of heading, radians.
    pub turn_rad: f64,
}

impl Sample {
    /// Whether the vehicle moved.
    pub fn moves(&self) -> bool {
        self.way_m.abs() > STANDS_M_PER_S * self.over_s
            || self.turn_rad.abs() > STANDS_RAD_PER_S * self.over_s
    }

    fn begin_s(&self) -> f64 {
        self.t_s - self.over_s
    }
}

/// The cause of a stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// The message `stop`.
    Stop,
    /// The commands end, so the lease lapses.
    Lease,
    /// The connection is cut.
    Cut,
    /// The adapter process is stopped, but not ended.
    Stopped,
    /// The adapter process is killed.
    Killed,
}

impl Cause {
    /// The name of the check.
    pub fn check(self) -> &'static str {
        match self {
            Self::Stop => "stop: message stop",
            Self::Lease => "stop: commands end",
            Self::Cut => "stop: link cut",
            Self::Stopped => "stop: adapter stopped",
            Self::Killed => "stop: adapter killed",
        }
    }

    /// The remedy if the vehicle does not stop in time.
    fn remedy(self) -> &'static str {
        match self {
            Self::Stop => "correct `stop_time_s` in `hello`, or make the vehicle brake harder",
            Self::Lease => {
                "keep the lease where the motors are: stand still when no `drive` arrives within `lease_s`"
            }
            Self::Cut => "stand still when the connection ends",
            Self::Stopped | Self::Killed => {
                "keep the lease in the vehicle or in a process separate from the adapter"
            }
        }
    }
}

/// Limits of a stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Commanded speed before the stop, metres per second.
    pub commanded_m_per_s: f64,
    /// Longest time from the cause until the vehicle stands still, seconds.
    pub time_s: f64,
}

/// Mean speed in the last moments before a time, metres per second; `None` without samples.
pub fn moving_m_per_s(samples: &[Sample], at_s: f64) -> Option<f64> {
    let before = samples.iter().filter(|sample| sample.t_s <= at_s && sample.t_s > at_s - BEFORE_S);
    let (way_m, over_s) =
        before.fold((0.0, 0.0), |(way, over), sample| (way + sample.way_m.abs(), over + sample.over_s));
    (over_s > 0.0).then(|| way_m / over_s)
}

/// Whether the last samples show a standing vehicle.
pub fn stands(samples: &[Sample]) -> bool {
    let Some(last) = samples.last() else { return false };
    let quiet = samples.iter().rev().take_while(|sample| !sample.moves()).last();
    quiet.is_some_and(|first| last.t_s - first.begin_s() >= QUIET_S)
}

/// Evaluates a stop from the samples before and after its cause, in the order of their times.
pub fn stop(cause: Cause, samples: &[Sample], cause_s: f64, limits: Limits) -> Row {
    let check = cause.check();
    let Some(speed) = moving_m_per_s(samples, cause_s) else {
        return Row::not_measured(check, "no motion was reported before the stop");
    };
    if speed < FAST_ENOUGH * limits.commanded_m_per_s {
        let says = format!(
            "the vehicle moved at {speed:.2} m/s although {:.2} m/s was commanded, so this was not a stop",
            limits.commanded_m_per_s
        );
        return Row::fail(check, Vec::new(), says);
    }
    let after: Vec<&Sample> = samples.iter().filter(|sample| sample.t_s > cause_s).collect();
    let mut known_until_s = cause_s;
    let mut figures = Stopping::default();
    for sample in after {
        if sample.begin_s() > known_until_s + GAP_S && !figures.is_quiet(known_until_s, cause_s) {
            let says = "the readings do not cover the whole stop";
            return Row::not_measured(check, says);
        }
        known_until_s = sample.t_s;
        figures.take(sample, cause_s);
    }
    if !figures.is_quiet(known_until_s, cause_s) {
        let for_s = known_until_s - cause_s;
        if for_s < limits.time_s {
            return Row::not_measured(check, "the readings do not cover the whole stop");
        }
        let says = format!("the vehicle was still moving after {for_s:.2} s; {}", cause.remedy());
        return Row::fail(check, figures.figures(limits), says);
    }
    let says = format!(
        "stood still {:.2} s and {:.3} m after the stop was triggered",
        figures.time_s, figures.way_m
    );
    let failed = format!("{says}, but {:.2} s is allowed; {}", limits.time_s, cause.remedy());
    Row::judged(check, figures.figures(limits), &says, &failed)
}

/// The result of a stop after which the vehicle moved again as soon as its stopped adapter continued.
pub fn moved_again(stop: Row) -> Row {
    let says = "the vehicle moved again when the adapter continued: the adapter carried out a command that had waited; \
                ignore a `drive` that is older than its lease";
    match stop.verdict {
        Verdict::Fail => stop,
        Verdict::Pass | Verdict::NotMeasured => Row::fail(stop.check, stop.figures, says),
    }
}

/// A stop as evaluated so far.
#[derive(Debug, Default)]
struct Stopping {
    time_s: f64,
    way_m: f64,
    turn_rad: f64,
}

impl Stopping {
    fn take(&mut self, sample: &Sample, cause_s: f64) {
        // Of a motion that had begun before the cause, only the later part counts.
        let share = ((sample.t_s - cause_s) / sample.over_s).min(1.0);
        if sample.moves() {
            self.time_s = sample.t_s - cause_s;
        }
        self.way_m += share * sample.way_m.abs();
        self.turn_rad += share * sample.turn_rad.abs();
    }

    fn is_quiet(&self, known_until_s: f64, cause_s: f64) -> bool {
        known_until_s - cause_s - self.time_s >= QUIET_S
    }

    fn figures(&self, limits: Limits) -> Vec<Figure> {
        vec![
            Figure::new("time", self.time_s, "s").at_most(limits.time_s),
            Figure::new("distance", self.way_m, "m"),
            Figure::new("turn", self.turn_rad.to_degrees(), "deg"),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits { commanded_m_per_s: 0.4, time_s: 1.0 };

    /// Samples of a vehicle that drives at 0.4 m/s, brakes from `brakes_s` at 0.5 m/s² and is heard until `until_s`.
    fn samples(brakes_s: f64, until_s: f64) -> Vec<Sample> {
        let way_m = |t_s: f64| {
            let braking = (t_s - brakes_s).clamp(0.0, 0.8);
            0.4 * t_s.min(brakes_s) + 0.4 * braking - 0.25 * braking * braking
        };
        let n = (until_s / 0.05) as u32;
        let at = |k: u32| f64::from(k) * 0.05;
        (1..=n)
            .map(|k| Sample {
                t_s: at(k),
                over_s: 0.05,
                way_m: way_m(at(k)) - way_m(at(k - 1)),
                turn_rad: 0.0,
            })
            .collect()
    }

    #[test]
    fn time_and_distance_run_from_the_cause() {
        let row = stop(Cause::Stop, &samples(2.1, 5.0), 2.0, LIMITS);
        assert_eq!(row.verdict, Verdict::Pass, "{row:?}");
        assert!((row.figures[0].value - 0.9).abs() < 0.051, "0.1 s of delay, 0.8 s of braking: {row:?}");
        assert!((row.figures[1].value - 0.2).abs() < 0.003, "{row:?}");
    }

    #[test]
    fn a_late_stop_fails_with_its_remedy() {
        let row = stop(Cause::Killed, &samples(2.6, 5.0), 2.0, LIMITS);
        assert!(row.verdict == Verdict::Fail && row.says.contains("separate from the adapter"), "{row:?}");
        let row = stop(Cause::Lease, &samples(9.0, 5.0), 2.0, LIMITS);
        assert!(row.verdict == Verdict::Fail && row.says.contains("still moving after 3.00 s"), "{row:?}");
    }

    #[test]
    fn nothing_is_claimed_about_what_was_not_seen() {
        let cut: Vec<Sample> = samples(2.1, 5.0).into_iter().filter(|sample| sample.t_s <= 2.1).collect();
        assert_eq!(stop(Cause::Cut, &cut, 2.0, LIMITS).verdict, Verdict::NotMeasured);
        let gap: Vec<Sample> =
            samples(2.1, 5.0).into_iter().filter(|sample| sample.t_s <= 2.1 || sample.t_s > 3.5).collect();
        assert_eq!(stop(Cause::Cut, &gap, 2.0, LIMITS).verdict, Verdict::NotMeasured);
        assert_eq!(stop(Cause::Cut, &[], 2.0, LIMITS).verdict, Verdict::NotMeasured);
        let stood = samples(0.0, 5.0);
        let row = stop(Cause::Cut, &stood, 2.0, LIMITS);
        assert!(row.verdict == Verdict::Fail && row.says.contains("was not a stop"), "{row:?}");
    }

    #[test]
    fn a_vehicle_stands_after_quiet_time_only() {
        assert!(!stands(&[]) && !stands(&samples(2.1, 3.0)) && stands(&samples(2.1, 4.0)));
    }
}
