//! The task of making a map, as far as rules and events see it; the map itself is in `engine/surveying.rs`.

use crate::ask::TaskLeft;
use world::Point;

/// A survey in progress.
#[derive(Clone)]
pub(crate) struct Survey {
    anchor: Point,
    tolerance_m: f64,
    /// Where the robot drives now.
    pub target: Point,
    /// Share of the floor within the wall that scans have shown, 0 to 1.
    pub explored: f64,
    /// Whether nothing is left to explore, so that the robot drives back.
    pub is_over: bool,
    /// Whether the map shows no floor with room for the hull at the robot's place, so that no way begins there.
    pub is_shut_in: bool,
}

impl Survey {
    pub(super) fn new(anchor: Point, tolerance_m: f64) -> Self {
        Self { anchor, tolerance_m, target: anchor, explored: 0.0, is_over: false, is_shut_in: false }
    }

    /// The drive back, in the form that planners receive. Planners are not asked during a survey.
    pub(super) fn left(&self) -> TaskLeft {
        TaskLeft::Goto { goal: self.anchor, tolerance_m: self.tolerance_m }
    }

    pub(super) fn is_done(&self, position: Point) -> bool {
        self.is_over && (position - self.anchor).norm() <= self.tolerance_m
    }
}
