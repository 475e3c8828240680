//! Recognizes a torn cable: the reel has taken up cable that must be out if the cable still leads to the robot, and
//! nothing pulls at one of its ends.

use super::slack::little_n;
use world::{Readings, tether::Reel};

/// Cable that must be missing, metres, besides the error of the position.
const MISSING_M: f64 = 0.5;
/// How long it must be missing, seconds.
const MISSING_S: f64 = 1.0;

/// Whether the cable is torn, from the encoder of the reel and the pull on the cable. A torn cable stays torn.
#[derive(Clone, Debug, Default)]
pub(super) struct Torn {
    /// How long cable has been missing, seconds.
    missing_s: f64,
    /// Length off the reel, and length that must be out, metres, when the cable was found torn.
    found_m: Option<(f64, f64)>,
}

impl Torn {
    /// Processes the readings after some time has passed. `least_m` is the length of the taut cable to the robot, less the
    /// error of the position, metres; `None` while it is not known. Without a measured pull, the encoder may be wrong, so
    /// nothing is concluded.
    pub(super) fn take(
        &mut self,
        readings: &Readings,
        least_m: Option<f64>,
        reel: Option<&Reel>,
        passed_s: f64,
    ) {
        let pulls = [readings.reel_pull_n, readings.robot_pull_n].into_iter().flatten();
        let pull_n = pulls.filter(|pull_n| pull_n.is_finite()).fold(f64::INFINITY, f64::min);
        let out_m = readings.paid_out_m.filter(|out_m| out_m.is_finite());
        let (Some(out_m), Some(least_m)) = (out_m, least_m) else { return };
        let is_missing = least_m - out_m > MISSING_M && pull_n <= little_n(reel, 0.0);
        self.missing_s = if is_missing { self.missing_s + passed_s } else { 0.0 };
        if self.missing_s > MISSING_S {
            self.found_m.get_or_insert((out_m, least_m));
        }
    }

    /// Length off the reel, and length that must be out, metres, when the cable was found torn; `None` for a whole cable.
    pub(super) fn found_m(&self) -> Option<(f64, f64)> {
        self.found_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a cable of which 5 m must be out counts as torn after some seconds with these readings.
    fn is_torn(out_m: f64, reel_pull_n: Option<f64>, robot_pull_n: Option<f64>, seconds: f64) -> bool {
        let readings = Readings { paid_out_m: Some(out_m), reel_pull_n, robot_pull_n, ..Readings::default() };
        let mut torn = Torn::default();
        (0..(seconds / 0.1) as usize).for_each(|_| torn.take(&readings, Some(5.0), None, 0.1));
        torn.found_m().is_some()
    }

    #[test]
    fn cable_that_is_missing_and_does_not_pull_at_one_end_is_torn() {
        assert!(is_torn(4.4, Some(0.0), Some(3.0), 1.5), "torn at the reel: the robot drags it");
        assert!(is_torn(4.4, Some(3.0), Some(0.0), 1.5), "torn at the robot: the reel takes it up");
        assert!(is_torn(4.4, None, Some(0.0), 1.5) && is_torn(0.0, Some(0.0), None, 1.5));
        assert!(!is_torn(4.4, Some(0.0), Some(0.0), 0.9), "for a moment");
        assert!(!is_torn(4.6, Some(0.0), Some(0.0), 9.0), "little is missing");
        assert!(!is_torn(0.0, Some(3.0), Some(3.0), 9.0), "it pulls at both ends: the map is wrong");
        assert!(!is_torn(0.0, None, None, 9.0) && !is_torn(0.0, Some(f64::NAN), None, 9.0), "not measured");
        assert!(!is_torn(f64::NAN, Some(0.0), None, 9.0));
    }

    #[test]
    fn a_torn_cable_stays_torn_and_nothing_is_concluded_while_the_position_is_lost() {
        let loose = Readings { paid_out_m: Some(0.0), reel_pull_n: Some(0.0), ..Readings::default() };
        let mut torn = Torn::default();
        torn.take(&loose, None, None, 9.0);
        assert_eq!(torn.found_m(), None);
        torn.take(&loose, Some(3.0), None, 2.0);
        assert_eq!(torn.found_m(), Some((0.0, 3.0)));
        torn.take(&loose, Some(0.0), None, 2.0);
        assert_eq!(torn.found_m(), Some((0.0, 3.0)));
    }
}
