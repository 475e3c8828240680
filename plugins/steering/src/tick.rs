//! The input of a pilot in one tick.

use crate::body::Body;
use geometry::Point;
use planner_api::{PoseEstimate, Sensed};

/// The situation in one tick.
#[derive(Debug, Clone, Copy)]
pub struct Tick<'a> {
    /// Mission time, seconds.
    pub t_s: f64,
    /// The robot's estimated pose.
    pub pose: PoseEstimate,
    /// The next target.
    pub target: Point,
    /// Whether the task ends at the target.
    pub is_last: bool,
    /// Nearby bodies, no-go zones included.
    pub bodies: &'a [Body],
}

impl<'a> Tick<'a> {
    /// Creates a tick bound for the target of the task.
    pub fn toward_target(sensed: &Sensed<'_>, bodies: &'a [Body]) -> Self {
        let is_last = sensed.targets_ahead.len() <= 1;
        Self { t_s: sensed.t_s, pose: sensed.pose, target: sensed.target, is_last, bodies }
    }

    /// Creates a tick bound for the next point of the plan, or for the target of the task if there is no plan.
    pub fn along_path(sensed: &Sensed<'_>, bodies: &'a [Body]) -> Self {
        let toward_target = Self::toward_target(sensed, bodies);
        let target = sensed.path_ahead.first().copied().unwrap_or(sensed.target);
        Self { target, is_last: toward_target.is_last && sensed.path_ahead.len() <= 1, ..toward_target }
    }
}
