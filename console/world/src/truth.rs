//! The true state of a simulated robot. No sensor reads it, and no input of a mission contains it.

use geometry::{Point, Pose};
use serde::{Deserialize, Serialize};

/// The true state in one tick.
#[derive(Debug, Clone, PartialEq)]
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
#[derive(Debug, Clone, PartialEq)]
pub struct TetherTruth {
    /// Length of cable between anchor and robot, metres.
    pub length_m: f64,
    /// Maximum wrap on one obstacle, radians.
    pub wrap_max_rad: f64,
    /// Total wrap, radians.
    pub wrap_total_rad: f64,
    /// Length beyond the straight line from the anchor to the robot, metres.
    pub detour_m: f64,
    /// How the cable lies; `None` for one that is always taut.
    pub lies: Option<CableLies>,
}

/// How a cable with weight lies on the floor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CableLies {
    /// The line of the cable from the anchor or, if it is torn, from the loose end to the robot, tank frame; empty in most
    /// ticks, to save space.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub line: Vec<Point>,
    /// Whether the hull is over a part of the cable that does not lead straight away from it.
    pub under_hull: bool,
    /// Pull at the reel, newtons.
    pub reel_pull_n: f64,
    /// Whether the cable is torn.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub torn: bool,
}
