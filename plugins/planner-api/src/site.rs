//! Where the mission takes place, as far as the drawing shows it.

use geometry::Limits;
use nalgebra::{Point2, Vector2};

/// The wall of the tank, its corners borrowed from the console.
pub type Boundary<'a> = geometry::Boundary<&'a [Point2<f64>]>;
/// The outline of an obstacle or zone, its corners borrowed from the console.
pub type Outline<'a> = geometry::Shape<&'a [Point2<f64>]>;

/// Something the robot must not touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Obstacle<'a> {
    /// Stable within a mission.
    pub id: u32,
    /// Its outline in the tank frame.
    pub outline: Outline<'a>,
    /// Whether it was discovered on the way (so its place carries the position error) or stands on the drawing.
    pub discovered: bool,
    /// How fast it moves, metres per second, tank frame; zero for what stands still. An estimate, and only what is sensed
    /// now is known to move.
    pub velocity_m_per_s: Vector2<f64>,
}

/// What is special about a part of the floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum ZoneKind {
    /// The robot must not enter.
    NoGo = 0,
    /// Dry floor.
    Land = 1,
    /// Flooded floor.
    Underwater = 2,
}

/// A part of the floor with a meaning of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zone<'a> {
    /// What is special about it.
    pub kind: ZoneKind,
    /// Its outline.
    pub outline: Outline<'a>,
}

/// The drawing of the tank, the robot and the margins that the mission demands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site<'a> {
    /// Grows whenever anything here changes.
    pub revision: u32,
    /// The wall.
    pub boundary: Boundary<'a>,
    /// Known and discovered obstacles.
    pub obstacles: &'a [Obstacle<'a>],
    /// Zones, later ones on top.
    pub zones: &'a [Zone<'a>],
    /// What the robot can do.
    pub limits: Limits,
    /// Width of the floor that the tool scans in one pass, metres.
    pub swath_m: f64,
    /// Distance to keep between the robot's hull and anything solid, metres.
    pub clearance_m: f64,
    /// Start of every random choice, so that a plan can be repeated.
    pub seed: u64,
}
