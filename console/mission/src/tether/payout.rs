//! Compares the length paid out by the reel with the length expected from the map.
//!
//! The mission's cable touches only obstacles on the map, but the real one may catch on an obstacle that has not been
//! seen yet. Only the encoder of the reel can reveal this. If two taut cables take the same route among the same
//! obstacles, their lengths differ by no more than the distances between their ends. A difference larger than the
//! position error therefore means that the routes differ.

use super::driven::KEPT_M;

/// Excess length that errors in the map may cause, metres; the position error is added.
const SLACK_M: f64 = 0.2;
/// Least excess length that sag and stretch may cause, as a share of the expected length.
const SAG_SHARE: f64 = 0.02;
/// Largest sag of a simulated cable beside that of a straight one that is dragged across the floor (`docs/tuning.md`).
const SAG_FACTOR: f64 = 1.5;
/// Length of cable left on the reel, metres, up to which the reel counts as empty.
const AT_END_M: f64 = 0.05;
/// How long the excess must last before the cable counts as caught, seconds.
const SNAG_S: f64 = 3.0;
/// Share of the permitted excess below which the cable length counts as expected again, and a caught cable as free.
const EXPLAINED: f64 = 0.25;
/// Minimum distance, metres, by which the robot goes back beyond the place where the cable length was last as expected,
/// to free a caught cable.
const FURTHER_BACK_M: f64 = 0.5;

/// The cable expected from the map.
#[derive(Debug, Clone, Copy)]
pub(super) struct Explained {
    /// Expected cable length, metres.
    pub length_m: f64,
    /// Position error with which the cable was laid, metres.
    pub error_m: f64,
    /// Number of points of the path driven so far.
    pub points: usize,
    /// The pull that taking up the cable needs, as a share of the pull of the reel; 0 if it is not known.
    pub pull_ratio: f64,
}

impl Explained {
    /// Excess length that sag and stretch may cause, metres. A straight cable of length L that is dragged across the floor
    /// sags by w² L³ / (24 T²), with w the friction of the floor per metre and T the pull of the reel: L / 24 times the
    /// square of the ratio of the pulls. A reel that is too weak leaves slack, which does not pull.
    fn sag_m(self) -> f64 {
        let dragged = SAG_FACTOR / 24.0 * self.pull_ratio.clamp(0.0, 1.0).powi(2);
        self.length_m * SAG_SHARE.max(dragged)
    }
}

/// The state that follows from the encoder of the reel.
#[derive(Clone, Debug, Default)]
pub(super) struct Payout {
    measured_m: Option<f64>,
    /// How long the excess has lasted, seconds.
    beyond_s: f64,
    /// Number of points of the path driven up to the place where the cable length was last as expected.
    free_points: usize,
}

impl Payout {
    /// Processes a measurement after some time has passed. If there is no measurement or no expected length, the
    /// comparison pauses.
    pub(super) fn take(
        &mut self,
        measured_m: Option<f64>,
        explained: Option<Explained>,
        reel_length_m: f64,
        passed_s: f64,
    ) {
        self.measured_m = measured_m.filter(|out_m| out_m.is_finite());
        let (Some(out_m), Some(explained)) = (self.measured_m, explained) else { return };
        let sag_m = explained.sag_m();
        // An empty reel can pay out no more cable, so a snag that has not been detected by then would never be detected.
        let is_at_end = out_m >= reel_length_m - AT_END_M;
        let slack_m = SLACK_M + explained.error_m + if is_at_end { 0.0 } else { sag_m };
        let excess_m = out_m - explained.length_m;
        if excess_m > slack_m {
            self.beyond_s += passed_s;
        } else if excess_m <= EXPLAINED * slack_m {
            (self.beyond_s, self.free_points) = (0.0, explained.points);
        }
    }

    /// Length of tether paid out, as measured by the encoder, metres.
    pub(super) fn measured_m(&self) -> Option<f64> {
        self.measured_m
    }

    /// The larger of the measured and the expected length, metres.
    pub(super) fn at_least_m(&self, explained_m: f64) -> f64 {
        self.measured_m.map_or(explained_m, |out_m| out_m.max(explained_m))
    }

    /// Whether the length off the reel is as expected.
    pub(super) fn is_expected(&self) -> bool {
        self.beyond_s == 0.0
    }

    /// What is out beyond the expected length is slack, not caught.
    pub(super) fn explain(&mut self) {
        self.beyond_s = 0.0;
    }

    /// Whether the cable counts as caught.
    pub(super) fn is_snagged(&self) -> bool {
        self.beyond_s > SNAG_S
    }

    /// How many of the `points` points of the path driven are left when the robot has gone back far enough to free a
    /// caught cable. Driving back undoes the effect of driving on, among known and unknown obstacles alike.
    ///
    /// The excess grows with the square of the distance driven since the cable touched the obstacle. Where the excess
    /// became noticeable, the cable may therefore already have been caught for about the same distance as it has been
    /// dragged since. Before that place, the cable comes off on the correct side, and the return path along it is
    /// clear.
    pub(super) fn points_to_go_back_to(&self, points: usize) -> usize {
        // On the way back, the path becomes shorter again.
        let free = self.free_points.min(points);
        let caught = points - free;
        free.saturating_sub(caught + (FURTHER_BACK_M / KEPT_M) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXPLAINED: Explained = Explained { length_m: 20.0, error_m: 0.1, points: 100, pull_ratio: 0.0 };

    /// Whether a cable counts as caught after five seconds in which this much more has been paid out than expected.
    fn is_caught(explained: Explained, excess_m: f64, reel_length_m: f64) -> bool {
        let mut payout = Payout::default();
        (0..50).for_each(|_| payout.take(Some(20.0 + excess_m), Some(explained), reel_length_m, 0.1));
        payout.is_snagged()
    }

    fn is_snagged(excess_m: f64, reel_length_m: f64) -> bool {
        is_caught(EXPLAINED, excess_m, reel_length_m)
    }

    #[test]
    fn the_sag_of_a_cable_that_the_reel_can_hardly_take_up_is_no_snag() {
        for (pull_ratio, at_most_m) in [(0.0, 0.7), (0.5, 0.7), (0.8, 1.1), (1.0, 1.55), (9.0, 1.55)] {
            let explained = Explained { pull_ratio, ..EXPLAINED };
            assert!(!is_caught(explained, at_most_m - 0.01, 30.0), "{pull_ratio}");
            assert!(is_caught(explained, at_most_m + 0.01, 30.0), "{pull_ratio}");
        }
    }

    #[test]
    fn at_the_end_of_the_reel_a_little_cable_too_much_shows_as_well() {
        assert!(is_snagged(0.8, 30.0) && !is_snagged(0.4, 30.0));
        assert!(is_snagged(0.4, 20.41) && !is_snagged(0.2, 20.21));
    }

    #[test]
    fn a_caught_cable_is_followed_back_as_far_again_as_it_was_dragged() {
        let mut payout = Payout::default();
        let taken = |payout: &mut Payout, out_m, points| {
            let explained = Explained { points, ..EXPLAINED };
            payout.take(Some(out_m), Some(explained), 99.0, 4.0);
        };
        taken(&mut payout, 20.0, 200);
        taken(&mut payout, 21.0, 240);
        assert!(payout.is_snagged());
        assert_eq!(payout.points_to_go_back_to(240), 200 - 40 - 10);
        assert_eq!(payout.points_to_go_back_to(100), 100 - 10, "the robot is already farther back than that");
        taken(&mut payout, 20.05, 150);
        assert!(!payout.is_snagged());
    }
}
