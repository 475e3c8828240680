//! Recognizes a torn cable: the reel has taken up cable that must be out if the cable still leads to the robot, and
//! nothing pulls at one of its ends. If a vehicle does not measure the pull, the encoder alone shows it: no cable to the robot
//! is shorter than the straight line to the anchor, whatever the map says.

use super::slack::little_n;
use world::{Readings, tether::Reel};

/// Cable that must be missing, metres, besides the error of the position.
const MISSING_M: f64 = 0.5;
/// How long it must be missing, seconds.
const MISSING_S: f64 = 1.0;

/// How long cable must be missing if the pull is not measured, seconds.
const MISSING_BY_ENCODER_S: f64 = 3.0;

/// The least length of a cable that leads to the robot, less the error of the position, metres.
#[derive(Debug, Clone, Copy)]
pub(super) struct Least {
    /// Along the taut line among the obstacles on the map.
    pub taut_m: f64,
    /// Along the straight line; `None` if nothing may be concluded from the encoder alone.
    pub straight_m: Option<f64>,
}

/// A cable that was found torn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Found {
    /// Length off the reel, metres.
    pub out_m: f64,
    /// Length that must be out, metres.
    pub needed_m: f64,
    /// Whether only the encoder shows it.
    pub by_encoder_alone: bool,
}

/// Whether the cable is torn, from the encoder of the reel and the pull on the cable. A torn cable stays torn.
#[derive(Clone, Debug, Default)]
pub(super) struct Torn {
    /// How long cable has been missing, seconds.
    missing_s: f64,
    /// Length off the reel at the last reading, and what the reel has taken up while cable was missing, metres.
    out_m: f64,
    drawn_m: f64,
    /// The lengths when the cable was found torn.
    found: Option<Found>,
}

impl Torn {
    /// Processes the readings after some time has passed. `least` is `None` while the position is not known.
    pub(super) fn take(
        &mut self,
        readings: &Readings,
        least: Option<Least>,
        reel: Option<&Reel>,
        passed_s: f64,
    ) {
        let pulls = [readings.reel_pull_n, readings.robot_pull_n].into_iter().flatten();
        let pull_n = pulls.filter(|pull_n| pull_n.is_finite()).reduce(f64::min);
        let out_m = readings.paid_out_m.filter(|out_m| out_m.is_finite());
        let (Some(out_m), Some(least)) = (out_m, least) else { return };
        let (needed_m, after_s) = match (pull_n, least.straight_m) {
            (Some(pull_n), _) if pull_n <= little_n(reel, 0.0) => (least.taut_m, MISSING_S),
            (None, Some(straight_m)) => (straight_m, MISSING_BY_ENCODER_S),
            _ => (0.0, MISSING_S),
        };
        let was_missing = self.is_missing();
        self.missing_s = if needed_m - out_m > MISSING_M { self.missing_s + passed_s } else { 0.0 };
        let drawn_m = (self.out_m - out_m).max(0.0);
        self.drawn_m = if was_missing { self.drawn_m + drawn_m } else { 0.0 };
        self.out_m = out_m;
        if self.missing_s > after_s {
            self.found.get_or_insert(Found { out_m, needed_m, by_encoder_alone: pull_n.is_none() });
        }
    }

    /// Whether cable is missing, or has been found torn: the length off the reel says nothing about the cable at the robot.
    pub(super) fn is_missing(&self) -> bool {
        self.missing_s > 0.0 || self.found.is_some()
    }

    /// What the reel has drawn in of its piece, metres, as far as it was seen.
    pub(super) fn drawn_m(&self) -> f64 {
        self.drawn_m
    }

    /// The lengths when the cable was found torn; `None` for a whole cable.
    pub(super) fn found(&self) -> Option<Found> {
        self.found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn least(taut_m: f64, straight_m: Option<f64>) -> Least {
        Least { taut_m, straight_m }
    }

    /// Whether a cable of which 5 m must be out counts as torn after some seconds with these readings.
    fn is_torn(out_m: f64, reel_pull_n: Option<f64>, robot_pull_n: Option<f64>, seconds: f64) -> bool {
        let readings = Readings { paid_out_m: Some(out_m), reel_pull_n, robot_pull_n, ..Readings::default() };
        let mut torn = Torn::default();
        (0..(seconds / 0.1) as usize).for_each(|_| torn.take(&readings, Some(least(5.0, None)), None, 0.1));
        torn.found().is_some()
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
        assert_eq!(torn.found(), None);
        torn.take(&loose, Some(least(3.0, None)), None, 2.0);
        let found = Some(Found { out_m: 0.0, needed_m: 3.0, by_encoder_alone: false });
        assert_eq!(torn.found(), found);
        torn.take(&loose, Some(least(0.0, None)), None, 2.0);
        assert_eq!(torn.found(), found);
    }

    #[test]
    fn what_the_reel_draws_in_of_its_piece_is_added_up() {
        let mut torn = Torn::default();
        for (out_m, drawn_m) in [(5.0, 0.0), (3.0, 0.0), (2.9, 0.1), (2.7, 0.3), (2.7, 0.3), (0.0, 3.0)] {
            let readings =
                Readings { paid_out_m: Some(out_m), reel_pull_n: Some(0.0), ..Readings::default() };
            torn.take(&readings, Some(least(5.0, None)), None, 0.6);
            assert!((torn.drawn_m() - drawn_m).abs() < 1e-9, "{out_m}: {}", torn.drawn_m());
        }
        assert!(torn.found().is_some());
    }

    #[test]
    fn without_a_measured_pull_the_encoder_alone_contradicts_the_straight_line() {
        let found = |out_m: f64, pull_n: Option<f64>, straight_m, seconds: f64| {
            let readings = Readings { paid_out_m: Some(out_m), reel_pull_n: pull_n, ..Readings::default() };
            let mut torn = Torn::default();
            (0..(seconds / 0.1) as usize)
                .for_each(|_| torn.take(&readings, Some(least(9.0, straight_m)), None, 0.1));
            torn.found()
        };
        let alone = Found { out_m: 0.0, needed_m: 5.0, by_encoder_alone: true };
        assert_eq!(found(0.0, None, Some(5.0), 3.5), Some(alone));
        assert_eq!(found(0.0, None, Some(5.0), 2.9), None, "for a moment");
        assert_eq!(found(5.0, None, Some(5.0), 9.0), None, "the map may be wrong, but not the straight line");
        assert_eq!(found(0.0, None, None, 9.0), None, "a simulation");
        assert_eq!(found(0.0, Some(3.0), Some(5.0), 9.0), None, "it pulls");
    }
}
