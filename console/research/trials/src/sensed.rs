//! The sensor input of a robot at the beginning of a mission, for the planners' tests.

use geometry::Point;
use planner_api::{Obstacle, PoseEstimate, Sensed};

/// A pose known exactly, looking east.
pub fn exact_pose(position: Point) -> PoseEstimate {
    PoseEstimate { position, heading_rad: 0.0, covariance: nalgebra::Matrix3::zeros() }
}

/// The sensor input of a robot that stands still at the beginning of a mission.
pub fn sensed_at_rest<'a>(at: Point, targets: &'a [Point], obstacles: &'a [Obstacle<'a>]) -> Sensed<'a> {
    Sensed { targets_ahead: targets, obstacles, ..Sensed::new(0, 0.1, exact_pose(at), targets[0]) }
}
