//! The tank in which a mission takes place.

use crate::message;
use nalgebra::Point2;

/// The wall of the tank; its corners are borrowed from the console.
pub type Boundary<'a> = geometry::Boundary<&'a [Point2<f64>]>;
/// The outline of an obstacle or zone; its corners are borrowed from the console.
pub type Outline<'a> = geometry::Shape<&'a [Point2<f64>]>;

/// An object that the robot must not touch, lent by the console.
pub type Obstacle<'a> = message::Obstacle<&'a [Point2<f64>]>;
/// A special part of the floor, lent by the console.
pub type Zone<'a> = message::Zone<&'a [Point2<f64>]>;
/// The tank, the robot, and the margins that the mission requires, lent by the console.
pub type Site<'a> = message::Site<&'a [Point2<f64>], &'a [Obstacle<'a>], &'a [Zone<'a>]>;

/// What is special about a part of the floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(u32)]
pub enum ZoneKind {
    /// The robot must not enter.
    NoGo = 0,
    /// Dry floor.
    Land = 1,
    /// Flooded floor.
    Underwater = 2,
}
