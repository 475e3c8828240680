//! What the reel has paid out, against what the map explains.
//!
//! The mission's cable knows only obstacles on the map; the true one may catch on a column that nobody has seen yet.
//! Only the encoder of the reel can reveal that. Two taut cables that lie alike among the same obstacles differ
//! by no more than their ends do, so more than the position error is a cable that lies otherwise.

use super::driven::KEPT_M;

/// Cable beyond what the map explains that errors of the map may cause, metres; the position error is added.
const SLACK_M: f64 = 0.2;
/// The same by sag and stretch, as a share of the cable that the map explains.
const SLACK_SHARE: f64 = 0.02;
/// A reel with no more than this left on it is at its end, metres.
const AT_END_M: f64 = 0.05;
/// More has to be out for this long before the cable counts as caught, seconds.
const SNAG_S: f64 = 3.0;
/// Share of the slack below which all cable counts as explained, and a caught one as free.
const EXPLAINED: f64 = 0.25;
/// A caught cable is free at least this much way before the place where the map last explained all of it, metres.
const FURTHER_BACK_M: f64 = 0.5;

/// What the map makes of the cable.
#[derive(Debug, Clone, Copy)]
pub(super) struct Explained {
    /// Cable that the map explains, metres.
    pub length_m: f64,
    /// Error of the position with which it was laid, metres.
    pub error_m: f64,
    /// Points of the way driven so far.
    pub points: usize,
}

/// The encoder of the reel, as far as the mission heeds it.
#[derive(Clone, Debug, Default)]
pub(super) struct Payout {
    measured_m: Option<f64>,
    /// For how long more has been out than the map explains, seconds.
    beyond_s: f64,
    /// Points of the way driven up to which the map explained all cable.
    free_points: usize,
}

impl Payout {
    /// A measurement after some time; without one, or with nothing to compare it with, the comparison rests.
    pub(super) fn take(
        &mut self,
        measured_m: Option<f64>,
        explained: Option<Explained>,
        reel_length_m: f64,
        passed_s: f64,
    ) {
        self.measured_m = measured_m.filter(|out_m| out_m.is_finite());
        let (Some(out_m), Some(explained)) = (self.measured_m, explained) else { return };
        let sag_m = SLACK_SHARE * explained.length_m;
        // A reel at its end can pay out no more: what has not come to light by then never will.
        let is_at_end = out_m >= reel_length_m - AT_END_M;
        let slack_m = SLACK_M + explained.error_m + if is_at_end { 0.0 } else { sag_m };
        let excess_m = out_m - explained.length_m;
        if excess_m > slack_m {
            self.beyond_s += passed_s;
        } else if excess_m <= EXPLAINED * slack_m {
            (self.beyond_s, self.free_points) = (0.0, explained.points);
        }
    }

    /// Tether paid out as measured by the encoder, metres.
    pub(super) fn measured_m(&self) -> Option<f64> {
        self.measured_m
    }

    /// The larger one of what is measured and what the map explains, metres.
    pub(super) fn at_least_m(&self, explained_m: f64) -> f64 {
        self.measured_m.map_or(explained_m, |out_m| out_m.max(explained_m))
    }

    /// Whether the cable counts as caught.
    pub(super) fn is_snagged(&self) -> bool {
        self.beyond_s > SNAG_S
    }

    /// Points of the way driven, of so many, to go back to, so that a caught cable comes free: driving back undoes whatever
    /// driving on has done to it, among obstacles known and unknown.
    ///
    /// The excess grows with the square of the way since the cable touched: where it is small enough to count as
    /// explained the cable may have been caught for as long again. Beyond that the cable comes off on the side on which it
    /// belongs, and the return path along it is clear.
    pub(super) fn points_to_go_back_to(&self, points: usize) -> usize {
        // On the way back there are fewer again.
        let free = self.free_points.min(points);
        let caught = points - free;
        free.saturating_sub(caught + (FURTHER_BACK_M / KEPT_M) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a cable counts as caught after five seconds of which the reel has paid out so much more than explained.
    fn is_snagged(excess_m: f64, reel_length_m: f64) -> bool {
        let mut payout = Payout::default();
        let explained = Explained { length_m: 20.0, error_m: 0.1, points: 100 };
        (0..50).for_each(|_| payout.take(Some(20.0 + excess_m), Some(explained), reel_length_m, 0.1));
        payout.is_snagged()
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
            let explained = Explained { length_m: 20.0, error_m: 0.1, points };
            payout.take(Some(out_m), Some(explained), 99.0, 4.0);
        };
        taken(&mut payout, 20.0, 200);
        taken(&mut payout, 21.0, 240);
        assert!(payout.is_snagged());
        assert_eq!(payout.points_to_go_back_to(240), 200 - 40 - 10);
        assert_eq!(payout.points_to_go_back_to(100), 100 - 10, "already on the way back, further than that");
        taken(&mut payout, 20.05, 150);
        assert!(!payout.is_snagged());
    }
}
