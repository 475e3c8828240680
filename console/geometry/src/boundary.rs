//! The wall of a tank.

use crate::{Point, polyline, shape};

/// The wall of the tank.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Boundary<P = Vec<Point>> {
    /// A round tank about the origin of the tank frame.
    Circle {
        /// Inner radius, metres.
        radius_m: f64,
    },
    /// A tank with straight walls; simple polygon, counter-clockwise.
    Polygon {
        /// Corners, metres.
        vertices: P,
    },
}

impl<P: AsRef<[Point]>> Boundary<P> {
    /// The same wall with its corners borrowed.
    pub fn as_ref(&self) -> Boundary<&[Point]> {
        match self {
            Self::Circle { radius_m } => Boundary::Circle { radius_m: *radius_m },
            Self::Polygon { vertices } => Boundary::Polygon { vertices: vertices.as_ref() },
        }
    }

    /// The same wall with corners of its own.
    pub fn to_owned(&self) -> Boundary {
        match self {
            Self::Circle { radius_m } => Boundary::Circle { radius_m: *radius_m },
            Self::Polygon { vertices } => Boundary::Polygon { vertices: vertices.as_ref().to_vec() },
        }
    }

    /// Whether a point lies on the floor.
    pub fn contains(&self, point: Point) -> bool {
        self.wall_distance_m(point) >= 0.0
    }

    /// Distance to the wall; negative outside the tank.
    pub fn wall_distance_m(&self, point: Point) -> f64 {
        match self {
            Self::Circle { radius_m } => radius_m - point.coords.norm(),
            Self::Polygon { vertices } => {
                let vertices = vertices.as_ref();
                let distance = polyline::distance_to_ring_m(vertices, point);
                if shape::ring_contains(vertices, point) { distance } else { -distance }
            }
        }
    }

    /// The smallest axis-aligned box around the floor: lower left and upper right corner.
    pub fn bounds(&self) -> (Point, Point) {
        match self {
            Self::Circle { radius_m } => (Point::new(-radius_m, -radius_m), Point::new(*radius_m, *radius_m)),
            Self::Polygon { vertices } => shape::bounds_of(vertices.as_ref()),
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
                let vertices = vertices.as_ref();
                let corners = shape::rectangle(low, high);
                let middle = nalgebra::center(&low, &high);
                let enters = |(a, b): (&Point, &Point)| {
                    let size = (high - low).min();
                    let steps = ((b - a).norm() / size * 2.0).ceil().clamp(1.0, 1e4) as usize;
                    (0..=steps).any(|k| in_box(&(a + (b - a) * (k as f64 / steps as f64))))
                };
                let sides = vertices.iter().zip(vertices.iter().cycle().skip(1));
                corners.iter().chain([&middle]).any(|p| shape::ring_contains(vertices, *p))
                    || sides.into_iter().any(enters)
            }
        }
    }

    /// Area of the whole floor, square metres.
    pub fn area_m2(&self) -> f64 {
        match self {
            Self::Circle { radius_m } => std::f64::consts::PI * radius_m * radius_m,
            Self::Polygon { vertices } => shape::ring_area_m2(vertices.as_ref()).abs(),
        }
    }
}
