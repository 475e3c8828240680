//! What a robot senses at the beginning of a mission, for the planners' tests.

use geometry::Point;
use planner_api::{Obstacle, PoseEstimate, Sensed};

/// A pose known exactly, looking east.
pub fn exact_pose(position: Point) -> PoseEstimate {
    PoseEstimate { position, heading_rad: 0.0, covariance: nalgebra::Matrix3::zeros() }
}

/// What a robot senses that stands still at the beginning of a mission.
pub fn sensed_at_rest<'a>(at: Point, targets: &'a [Point], obstacles: &'a [Obstacle<'a>]) -> Sensed<'a> {
    Sensed {
        tick: 0,
        t_s: 0.0,
        dt_s: 0.1,
        pose: exact_pose(at),
        v_m_per_s: 0.0,
        w_rad_per_s: 0.0,
        target: targets[0],
        targets_ahead: targets,
        path_ahead: &[],
        obstacles,
    }
}
