//! What stands on the floor: boundary, obstacles, stations, zones.

use crate::{geometry::Point, shape::Shape};
use serde::{Deserialize, Serialize};

/// The wall of the tank.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Boundary {
    /// A round tank about the origin of the tank frame.
    Circle {
        /// Inner radius, metres.
        radius_m: f64,
    },
    /// A tank with straight walls; simple polygon, counter-clockwise.
    Polygon {
        /// Corners, metres.
        vertices: Vec<Point>,
    },
}

impl Boundary {
    /// Whether a point lies on the floor.
    pub fn contains(&self, point: Point) -> bool {
        self.wall_distance_m(point) >= 0.0
    }

    /// Distance to the wall; negative outside the tank.
    pub fn wall_distance_m(&self, point: Point) -> f64 {
        match self {
            Self::Circle { radius_m } => radius_m - point.coords.norm(),
            Self::Polygon { vertices } => {
                let distance = crate::polyline::distance_to_ring_m(vertices, point);
                if crate::shape::ring_contains(vertices, point) { distance } else { -distance }
            }
        }
    }

    /// The smallest axis-aligned box around the floor: lower left and upper right corner.
    pub fn bounds(&self) -> (Point, Point) {
        match self {
            Self::Circle { radius_m } => (Point::new(-radius_m, -radius_m), Point::new(*radius_m, *radius_m)),
            Self::Polygon { vertices } => crate::shape::bounds_of(vertices),
        }
    }

    /// Whether a box, given by its south west and north east corners, holds some of the floor.
    pub fn meets_box(&self, low: Point, high: Point) -> bool {
        let in_box = |p: &Point| low.x < p.x && p.x < high.x && low.y < p.y && p.y < high.y;
        match self {
            Self::Circle { radius_m } => {
                let nearest = Point::origin().sup(&low).inf(&high);
                nearest.coords.norm() < *radius_m
            }
            Self::Polygon { vertices } => {
                let corners = crate::coverage::regions::rectangle(low, high);
                let middle = nalgebra::center(&low, &high);
                let enters = |(a, b): (&Point, &Point)| {
                    let size = (high - low).min();
                    let steps = ((b - a).norm() / size * 2.0).ceil().clamp(1.0, 1e4) as usize;
                    (0..=steps).any(|k| in_box(&(a + (b - a) * (k as f64 / steps as f64))))
                };
                let sides = vertices.iter().zip(vertices.iter().cycle().skip(1));
                corners.iter().chain([&middle]).any(|p| crate::shape::ring_contains(vertices, *p))
                    || sides.into_iter().any(enters)
            }
        }
    }

    /// Area of the whole floor, square metres.
    pub fn area_m2(&self) -> f64 {
        match self {
            Self::Circle { radius_m } => std::f64::consts::PI * radius_m * radius_m,
            Self::Polygon { vertices } => crate::shape::ring_area_m2(vertices).abs(),
        }
    }
}

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
