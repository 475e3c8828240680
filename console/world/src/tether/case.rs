//! The input of a certificate: a path, its surroundings, and the limits of the tether.

use super::{cable::Cable, pull::PullLimits};
use crate::tank::Obstacle;
use geometry::{Boundary, Point};
use serde::{Deserialize, Serialize};

/// The limits of the tether.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Length of the tether on the reel, metres.
    pub reel_length_m: f64,
    /// Largest wrap on one obstacle, radians.
    pub wrap_max_rad: f64,
    /// Largest total wrap, radians.
    pub wrap_total_max_rad: f64,
}

/// A path to certify; everything in the tank frame.
#[derive(Debug, Clone, Copy)]
pub struct Case<'a> {
    /// The whole path.
    pub path: &'a [Point],
    /// The point where the tether enters the tank.
    pub anchor: Point,
    /// The cable at the start of the path; without it, the cable runs straight to the first point.
    pub cable: Option<&'a Cable>,
    /// The wall.
    pub boundary: &'a Boundary,
    /// Obstacles, known and found.
    pub obstacles: &'a [Obstacle],
    /// Distance that the centre of the hull keeps from everything solid, metres: hull radius plus clearance.
    pub room_m: f64,
    /// The limits of the tether.
    pub limits: Limits,
    /// The limits of the pull; `None` if the pull is not checked.
    pub pull: Option<PullLimits>,
    /// Whether the path must end at the anchor with the tether reeled in.
    pub returns: bool,
    /// Cuts: lines that the path must not cross.
    pub cuts: &'a [Vec<Point>],
}
