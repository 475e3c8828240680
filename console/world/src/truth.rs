//! The true state of a simulated robot. No sensor reads it, and no input of a mission contains it.

use geometry::Pose;

/// The true state in one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// True pose.
    pub pose: Pose,
    /// Distance from the hull to the nearest solid object, metres; negative in a collision.
    pub clearance_m: f64,
    /// Whether the hull came into contact with something in this tick.
    pub collided: bool,
    /// True geometry of the tether; `None` without one.
    pub tether: Option<TetherTruth>,
}

/// The true geometry of the tether.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TetherTruth {
    /// Length of cable between anchor and robot, metres.
    pub length_m: f64,
    /// Maximum wrap on one obstacle, radians.
    pub wrap_max_rad: f64,
    /// Total wrap, radians.
    pub wrap_total_rad: f64,
    /// Length beyond the straight line from the anchor to the robot, metres.
    pub detour_m: f64,
}
