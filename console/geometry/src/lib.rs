//! Points, poses, shapes, paths and motion on a tank floor, shared by the console, the planner API and the planners.
//!
//! All coordinates are in the tank frame: origin at the tank's centre, x east, y north, metres; angles in radians,
//! counter-clockwise from east. SI units throughout.

pub mod boundary;
pub mod braking;
pub mod convex;
pub mod follower;
pub mod motion;
pub mod pace;
pub mod polyline;
pub mod pose;
pub mod shape;
#[cfg(feature = "serde")]
pub mod symmetric;

pub use boundary::Boundary;
pub use braking::Braking;
pub use follower::PathFollower;
pub use motion::{Drive, Limits, Motion};
pub use pace::{Amphibious, Pace};
pub use pose::{Point, Pose, Vector, direction_or, unit_vector, wrap_angle_rad};
pub use shape::Shape;
