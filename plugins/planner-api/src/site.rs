//! Where the mission takes place, as far as the drawing shows it.

use nalgebra::{Point2, Vector2};

/// The wall of the tank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Boundary<'a> {
    /// A round tank about the origin.
    Circle {
        /// Inner radius, metres.
        radius_m: f64,
    },
    /// Straight walls; simple polygon, counter-clockwise.
    Polygon {
        /// Corners.
        vertices: &'a [Point2<f64>],
    },
}

/// The outline of an obstacle or zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outline<'a> {
    /// A disc; radius zero is a point obstacle.
    Disc {
        /// Centre.
        center: Point2<f64>,
        /// Radius, metres.
        radius_m: f64,
    },
    /// A convex polygon, counter-clockwise.
    Polygon {
        /// Corners.
        vertices: &'a [Point2<f64>],
    },
    /// A line of some thickness.
    Polyline {
        /// Corners of the centre line.
        points: &'a [Point2<f64>],
        /// Half the thickness, metres.
        half_width_m: f64,
    },
}

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

/// How the robot moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[repr(u32)]
pub enum Motion {
    /// In any direction at once, as the papers' point robots.
    Point = 0,
    /// Ahead and turning, as tracked and wheeled robots.
    Unicycle = 1,
}

/// What the robot can do.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Limits {
    /// How it moves.
    pub motion: Motion,
    /// Largest speed, metres per second.
    pub v_max_m_per_s: f64,
    /// Largest turn rate, radians per second.
    pub w_max_rad_per_s: f64,
    /// Radius of the smallest circle around the robot, metres.
    pub radius_m: f64,
    /// How far it sees obstacles, metres.
    pub sensing_range_m: f64,
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
