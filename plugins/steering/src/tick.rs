//! What a pilot goes by in one tick.

use crate::body::Body;
use geometry::Point;
use planner_api::{PoseEstimate, Sensed};

/// The situation in one tick.
#[derive(Debug, Clone, Copy)]
pub struct Tick<'a> {
    /// Mission time, seconds.
    pub t_s: f64,
    /// Where the robot believes it is.
    pub pose: PoseEstimate,
    /// Where to go next.
    pub target: Point,
    /// Whether the task ends at the target.
    pub is_last: bool,
    /// What is near, no-go zones included.
    pub bodies: &'a [Body],
}

impl<'a> Tick<'a> {
    /// Bound for the target of the task.
    pub fn toward_target(sensed: &Sensed<'_>, bodies: &'a [Body]) -> Self {
        let is_last = sensed.targets_ahead.len() <= 1;
        Self { t_s: sensed.t_s, pose: sensed.pose, target: sensed.target, is_last, bodies }
    }

    /// Bound for the next point of the plan; for the target of the task where there is no plan.
    pub fn along_path(sensed: &Sensed<'_>, bodies: &'a [Body]) -> Self {
        let toward_target = Self::toward_target(sensed, bodies);
        let target = sensed.path_ahead.first().copied().unwrap_or(sensed.target);
        Self { target, is_last: toward_target.is_last && sensed.path_ahead.len() <= 1, ..toward_target }
    }
}
