//! What the reel has paid out, against what the map explains.
//!
//! The mission's cable knows only obstacles on the map; the true one may catch on a column that nobody has seen yet.
//! The encoder of the reel is the one sense that tells. Two taut cables that lie alike among the same obstacles differ
//! by no more than their ends do, so more than the position error is a cable that lies otherwise.

use super::{EASED, KEPT_M};

/// Cable beyond what the map explains that errors of the map may cause, metres; the position error is added.
const SLACK_M: f64 = 0.2;
/// The same by sag and stretch, as a share of the cable that the map explains.
const SLACK_SHARE: f64 = 0.02;
/// More has to be out for this long before the cable counts as caught, seconds.
const SNAG_S: f64 = 3.0;
/// Share of the slack below which all cable counts as explained.
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
#[derive(Debug, Default)]
pub(super) struct Payout {
    measured_m: Option<f64>,
    /// For how long more has been out than the map explains, seconds.
    beyond_s: f64,
    /// Points of the way driven up to which the map explained all cable.
    free_points: usize,
}

impl Payout {
    /// A measurement after some time; without one, or with nothing to compare it with, the comparison rests.
    pub(super) fn take(&mut self, measured_m: Option<f64>, explained: Option<Explained>, passed_s: f64) {
        self.measured_m = measured_m.filter(|out_m| out_m.is_finite());
        let (Some(out_m), Some(explained)) = (self.measured_m, explained) else { return };
        let slack_m = SLACK_M + explained.error_m + SLACK_SHARE * explained.length_m;
        let excess_m = out_m - explained.length_m;
        if excess_m > slack_m {
            self.beyond_s += passed_s;
        } else if excess_m <= EASED * slack_m {
            self.beyond_s = 0.0;
        }
        if excess_m <= EXPLAINED * slack_m {
            self.free_points = explained.points;
        }
    }

    /// What the encoder tells, metres.
    pub(super) fn measured_m(&self) -> Option<f64> {
        self.measured_m
    }

    /// The larger one of what is measured and what the map explains, metres.
    pub(super) fn at_least_m(&self, explained_m: f64) -> f64 {
        self.measured_m.map_or(explained_m, |out_m| out_m.max(explained_m))
    }

    /// Whether the cable counts as caught.
    pub(super) fn is_caught(&self) -> bool {
        self.beyond_s > SNAG_S
    }

    /// Points of the way driven, of so many, to go back to, so that a caught cable comes free: driving back undoes whatever
    /// driving on has done to it, among obstacles known and unknown.
    ///
    /// The excess grows with the square of the way since the cable touched: where it is small enough to count as
    /// explained the cable may have been caught for as long again. Beyond that the cable comes off on the side on which it
    /// belongs, and the way home along it is clear.
    pub(super) fn points_to_go_back_to(&self, points: usize) -> usize {
        let caught = points.saturating_sub(self.free_points);
        self.free_points.saturating_sub(caught + (FURTHER_BACK_M / KEPT_M) as usize)
    }
}
