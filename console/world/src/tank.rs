//! What stands on the floor: obstacles, stations, zones.

use geometry::{Boundary, Point, Shape};
use serde::{Deserialize, Serialize};

/// Names an obstacle within one world.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ObstacleId(pub u32);

/// Something the robot must not touch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Obstacle {
    /// Unique within the world.
    pub id: ObstacleId,
    /// What the drawing calls it, for people.
    pub name: String,
    /// Its outline in the tank frame.
    pub shape: Shape,
    /// Whether it is on the drawing; the robot must discover the others.
    pub known: bool,
}

/// Names an acoustic-emission station.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct StationId(pub u32);

/// An acoustic-emission sensor at a surveyed place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Station {
    /// Unique within the world.
    pub id: StationId,
    /// What the drawing calls it, for people.
    pub name: String,
    /// Surveyed position, metres.
    pub position: Point,
}

/// What is special about a part of the floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ZoneKind {
    /// The robot must not enter.
    NoGo,
    /// Dry floor.
    Land,
    /// Flooded floor.
    Underwater,
}

/// A part of the floor with a meaning of its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Zone {
    /// What the drawing calls it.
    pub name: String,
    /// What is special about it.
    pub kind: ZoneKind,
    /// Its outline.
    pub shape: Shape,
}

/// The tank as it is on the drawing, or as it truly is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct World {
    /// The wall.
    pub boundary: Boundary,
    /// Columns, pipes, sumps, in order of their ids.
    pub obstacles: Vec<Obstacle>,
    /// Acoustic-emission stations, in order of their ids.
    pub stations: Vec<Station>,
    /// Zones, later ones on top.
    pub zones: Vec<Zone>,
}

impl World {
    /// The world as the drawing has it: without the obstacles that must be discovered.
    #[must_use]
    pub fn as_drawn(&self) -> Self {
        let obstacles = self.obstacles.iter().filter(|o| o.known).cloned().collect();
        Self { obstacles, ..self.clone() }
    }
}
