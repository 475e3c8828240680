//! Outlines of obstacles and zones.

use crate::{
    Point, Vector,
    polyline::{self, edges},
};
use nalgebra::Isometry2;

/// The outline of an obstacle or a zone.
///
/// `P` is where the corners lie: `Shape` has its own, `Shape<&[Point]>` borrows them, as planners see it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Shape<P = Vec<Point>> {
    /// A round column or pipe.
    Disc {
        /// Centre, metres.
        center: Point,
        /// Radius, metres; may be zero for a point obstacle as the papers have it.
        radius_m: f64,
    },
    /// A convex polygon, counter-clockwise.
    Polygon {
        /// Corners, metres.
        vertices: P,
    },
    /// A pipe or wall of some thickness along straight pieces.
    Polyline {
        /// Corners of the centre line, metres.
        points: P,
        /// Half the thickness, metres.
        half_width_m: f64,
    },
}

impl<P: AsRef<[Point]>> Shape<P> {
    /// The same shape with its corners borrowed.
    pub fn as_ref(&self) -> Shape<&[Point]> {
        match self {
            Self::Disc { center, radius_m } => Shape::Disc { center: *center, radius_m: *radius_m },
            Self::Polygon { vertices } => Shape::Polygon { vertices: vertices.as_ref() },
            Self::Polyline { points, half_width_m } => {
                Shape::Polyline { points: points.as_ref(), half_width_m: *half_width_m }
            }
        }
    }

    /// The same shape with corners of its own.
    pub fn to_owned(&self) -> Shape {
        self.map(|point| *point)
    }

    /// The same shape after a rigid motion.
    #[must_use]
    pub fn transformed(&self, motion: &Isometry2<f64>) -> Shape {
        self.map(|point| motion * point)
    }

    fn map(&self, place: impl Fn(&Point) -> Point) -> Shape {
        let all = |points: &P| points.as_ref().iter().map(&place).collect();
        match self {
            Self::Disc { center, radius_m } => Shape::Disc { center: place(center), radius_m: *radius_m },
            Self::Polygon { vertices } => Shape::Polygon { vertices: all(vertices) },
            Self::Polyline { points, half_width_m } => {
                Shape::Polyline { points: all(points), half_width_m: *half_width_m }
            }
        }
    }

    /// A point that stands for the whole: the centre of a disc, the mean of the corners otherwise.
    pub fn center(&self) -> Point {
        match self {
            Self::Disc { center, .. } => *center,
            Self::Polygon { vertices: points } | Self::Polyline { points, .. } => mean_of(points.as_ref()),
        }
    }

    /// Distance from a point to the outline, metres; negative inside.
    pub fn distance_m(&self, point: Point) -> f64 {
        match self.as_ref() {
            Shape::Disc { center, radius_m } => (point - center).norm() - radius_m,
            Shape::Polygon { vertices } => {
                let distance = polyline::distance_to_ring_m(vertices, point);
                if ring_contains(vertices, point) { -distance } else { distance }
            }
            Shape::Polyline { points, half_width_m } => polyline::distance_m(points, point) - half_width_m,
        }
    }

    /// The smallest axis-aligned box around it: south west and north east corner.
    pub fn bounds(&self) -> (Point, Point) {
        let (corners, margin): (&[Point], f64) = match self {
            Self::Disc { center, radius_m } => (std::slice::from_ref(center), *radius_m),
            Self::Polygon { vertices } => (vertices.as_ref(), 0.0),
            Self::Polyline { points, half_width_m } => (points.as_ref(), *half_width_m),
        };
        let (low, high) = bounds_of(corners);
        let grow = Vector::new(margin, margin);
        (low - grow, high + grow)
    }
}

/// The mean of some points; the origin without any.
pub(crate) fn mean_of(points: &[Point]) -> Point {
    let sum: Vector = points.iter().map(|p| p.coords).sum();
    Point::from(sum / points.len().max(1) as f64)
}

/// The smallest axis-aligned box around some points.
pub fn bounds_of(points: &[Point]) -> (Point, Point) {
    let far = f64::INFINITY;
    points
        .iter()
        .fold((Point::new(far, far), Point::new(-far, -far)), |(low, high), p| (low.inf(p), high.sup(p)))
}

/// Whether a point lies inside a simple polygon (crossing number).
pub fn ring_contains(vertices: &[Point], point: Point) -> bool {
    edges(vertices).fold(false, |inside, (a, b)| {
        let crosses =
            (a.y > point.y) != (b.y > point.y) && point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x;
        inside != crosses
    })
}

/// A box from its south west and north east corners, counter-clockwise.
pub fn rectangle(low: Point, high: Point) -> Vec<Point> {
    vec![low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)]
}

/// Signed area of a simple polygon, positive when counter-clockwise.
pub fn ring_area_m2(vertices: &[Point]) -> f64 {
    edges(vertices).map(|(a, b)| a.coords.perp(&b.coords)).sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<Point> {
        vec![Point::new(0.0, 0.0), Point::new(2.0, 0.0), Point::new(2.0, 2.0), Point::new(0.0, 2.0)]
    }

    #[test]
    fn the_distance_to_a_polygon_is_negative_inside() {
        let shape = Shape::Polygon { vertices: square() };
        assert!((shape.distance_m(Point::new(1.0, 1.0)) + 1.0).abs() < 1e-12);
        assert!((shape.distance_m(Point::new(3.0, 1.0)) - 1.0).abs() < 1e-12);
        assert!((ring_area_m2(&square()) - 4.0).abs() < 1e-12);
    }

    #[test]
    fn a_moved_disc_keeps_its_radius() {
        let disc: Shape = Shape::Disc { center: Point::new(1.0, 0.0), radius_m: 0.5 };
        let moved =
            disc.transformed(&Isometry2::new(nalgebra::Vector2::new(0.0, 1.0), std::f64::consts::FRAC_PI_2));
        assert!((moved.center() - Point::new(0.0, 2.0)).norm() < 1e-12);
        assert!((moved.distance_m(Point::new(0.0, 3.0)) - 0.5).abs() < 1e-12);
    }
}
