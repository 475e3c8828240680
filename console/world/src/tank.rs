//! The tank: wall, obstacles, stations and zones.

use geometry::{Boundary, Point, Shape};
use serde::{Deserialize, Serialize};

/// Identifies an obstacle within a world.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ObstacleId(pub u32);

impl ObstacleId {
    /// Ids from this one on belong to a tracker that does not know the drawing. Such a tracker may use the id of a
    /// drawn obstacle for another obstacle, so the console replaces all ids of the tracker. As a result, a drawn
    /// obstacle that the tracker sees has an id that is not on the drawing.
    pub const FOREIGN: Self = Self(1_000_000);
}

/// An object that the robot must not touch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Obstacle {
    /// Unique within the world.
    pub id: ObstacleId,
    /// The human-readable name on the drawing.
    pub name: String,
    /// The outline, tank frame.
    pub shape: Shape,
    /// Whether the obstacle is on the drawing. If not, the robot must discover the obstacle.
    pub known: bool,
}

/// Identifies an acoustic-emission station within a world.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct StationId(pub u32);

/// An acoustic-emission sensor at a surveyed position.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Station {
    /// Unique within the world.
    pub id: StationId,
    /// The human-readable name on the drawing.
    pub name: String,
    /// Surveyed position, metres, tank frame.
    pub position: Point,
}

/// A special property of a part of the floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ZoneKind {
    /// Floor that the robot must not enter.
    NoGo,
    /// Dry floor.
    Land,
    /// Flooded floor.
    Underwater,
}

/// A part of the floor with special properties.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Zone {
    /// The name on the drawing.
    pub name: String,
    /// The special property of the zone.
    pub kind: ZoneKind,
    /// The outline, tank frame.
    pub shape: Shape,
}

/// The tank as drawn, as known, or as it truly is.
///
/// ```
/// use world::{Boundary, Station, StationId, Point, World};
/// let position = Point::new(9.5, 0.0);
/// let stations = vec![Station { id: StationId(1), name: "S1".into(), position }];
/// let tank = World { boundary: Boundary::Circle { radius_m: 10.0 }, obstacles: vec![], stations, zones: vec![] };
/// assert_eq!(tank.boundary.wall_distance_m(tank.stations[0].position), 0.5);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct World {
    /// The wall.
    pub boundary: Boundary,
    /// Obstacles such as columns, pipes and sumps, in order of id.
    pub obstacles: Vec<Obstacle>,
    /// Acoustic-emission stations, in order of id.
    pub stations: Vec<Station>,
    /// Zones; where they overlap, the last one counts.
    pub zones: Vec<Zone>,
}

impl World {
    /// Returns the tank as drawn, without the obstacles that must be discovered.
    ///
    /// ```
    /// use world::{Boundary, Obstacle, ObstacleId, Point, Shape, World};
    /// let column = |id, known| {
    ///     let shape = Shape::Disc { center: Point::new(f64::from(id), 0.0), radius_m: 0.3 };
    ///     Obstacle { id: ObstacleId(id), name: format!("C{id}"), shape, known }
    /// };
    /// let (boundary, obstacles) = (Boundary::Circle { radius_m: 9.0 }, vec![column(1, true), column(2, false)]);
    /// let tank = World { boundary, obstacles, stations: vec![], zones: vec![] };
    /// assert_eq!(tank.as_drawn().obstacles.len(), 1);
    /// ```
    #[must_use]
    pub fn as_drawn(&self) -> Self {
        let obstacles = self.obstacles.iter().filter(|o| o.known).cloned().collect();
        Self { obstacles, ..self.clone() }
    }
}
