//! The wall of a tank.

use crate::{Point, Vector, polyline, shape};

/// The wall of a tank; `P` stores the corners, as for [`Shape`](crate::Shape).
///
/// ```
/// use geometry::{Boundary, Point};
/// let tank: Boundary = Boundary::Circle { radius_m: 10.0 };
/// assert_eq!(tank.wall_distance_m(Point::new(6.0, 8.0)), 0.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Boundary<P = Vec<Point>> {
    /// A round tank about the origin of the tank frame.
    Circle {
        /// Inner radius, metres.
        radius_m: f64,
    },
    /// A tank with straight walls: a simple polygon, counter-clockwise.
    Polygon {
        /// Corners, metres.
        vertices: P,
    },
}

impl<P: AsRef<[Point]>> Boundary<P> {
    /// The same wall with borrowed corners.
    ///
    /// ```
    /// use geometry::{Boundary, Point, shape::rectangle};
    /// let vertices = rectangle(Point::new(0.0, 0.0), Point::new(3.0, 2.0));
    /// let tank = Boundary::Polygon { vertices: vertices.clone() };
    /// assert_eq!(tank.as_ref(), Boundary::Polygon { vertices: &vertices[..] });
    /// ```
    pub fn as_ref(&self) -> Boundary<&[Point]> {
        match self {
            Self::Circle { radius_m } => Boundary::Circle { radius_m: *radius_m },
            Self::Polygon { vertices } => Boundary::Polygon { vertices: vertices.as_ref() },
        }
    }

    /// The same wall with owned corners.
    ///
    /// ```
    /// use geometry::{Boundary, Point, shape::rectangle};
    /// let vertices = rectangle(Point::new(0.0, 0.0), Point::new(3.0, 2.0));
    /// let tank = Boundary::Polygon { vertices: &vertices[..] }.to_owned();
    /// assert_eq!(tank.area_m2(), 6.0);
    /// ```
    pub fn to_owned(&self) -> Boundary {
        match self {
            Self::Circle { radius_m } => Boundary::Circle { radius_m: *radius_m },
            Self::Polygon { vertices } => Boundary::Polygon { vertices: vertices.as_ref().to_vec() },
        }
    }

    /// Whether a point is on the floor or on the wall.
    ///
    /// ```
    /// use geometry::{Boundary, Point};
    /// let tank: Boundary = Boundary::Circle { radius_m: 10.0 };
    /// assert!(tank.contains(Point::new(9.0, 0.0)) && !tank.contains(Point::new(9.0, 9.0)));
    /// ```
    pub fn contains(&self, point: Point) -> bool {
        self.wall_distance_m(point) >= 0.0
    }

    /// Distance to the wall, metres; negative outside the tank.
    ///
    /// ```
    /// use geometry::{Boundary, Point, shape::rectangle};
    /// let tank = Boundary::Polygon { vertices: rectangle(Point::new(0.0, 0.0), Point::new(3.0, 2.0)) };
    /// assert_eq!(tank.wall_distance_m(Point::new(1.5, 0.5)), 0.5);
    /// assert_eq!(tank.wall_distance_m(Point::new(4.0, 1.0)), -1.0);
    /// ```
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

    /// Distance along a ray to the wall, metres; infinite if the ray does not reach it. `direction` has length 1.
    ///
    /// ```
    /// use geometry::{Boundary, Point, Vector};
    /// let tank: Boundary = Boundary::Circle { radius_m: 10.0 };
    /// assert_eq!(tank.ray_m(Point::new(4.0, 0.0), Vector::x()), 6.0);
    /// ```
    pub fn ray_m(&self, from: Point, direction: Vector) -> f64 {
        match self {
            Self::Circle { radius_m } => {
                let along = from.coords.dot(&direction);
                let rest = radius_m * radius_m - from.coords.norm_squared() + along * along;
                if rest < 0.0 { f64::INFINITY } else { (rest.sqrt() - along).max(0.0) }
            }
            Self::Polygon { vertices } => {
                let hits = polyline::edges(vertices.as_ref()).filter_map(|(a, b)| {
                    let (edge, to) = (b - a, a - from);
                    let across = direction.perp(&edge);
                    let (along_m, share) = (to.perp(&edge) / across, to.perp(&direction) / across);
                    (across != 0.0 && along_m >= 0.0 && (0.0..=1.0).contains(&share)).then_some(along_m)
                });
                hits.fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// The smallest axis-aligned box around the floor: its south-west and north-east corners.
    ///
    /// ```
    /// let tank: geometry::Boundary = geometry::Boundary::Circle { radius_m: 10.0 };
    /// let (low, high) = tank.bounds();
    /// assert_eq!((low.x, high.y), (-10.0, 10.0));
    /// ```
    pub fn bounds(&self) -> (Point, Point) {
        match self {
            Self::Circle { radius_m } => (Point::new(-radius_m, -radius_m), Point::new(*radius_m, *radius_m)),
            Self::Polygon { vertices } => shape::bounds_of(vertices.as_ref()),
        }
    }

    /// Whether a box, given by its south-west and north-east corners, contains some of the floor.
    ///
    /// Walls are sampled at intervals of half the shorter side of the box, so a corner of the floor that extends into the
    /// box by less than that may be missed.
    ///
    /// ```
    /// use geometry::{Boundary, Point};
    /// let tank: Boundary = Boundary::Circle { radius_m: 10.0 };
    /// assert!(tank.meets_box(Point::new(9.0, -1.0), Point::new(12.0, 1.0)));
    /// assert!(!tank.meets_box(Point::new(9.0, 9.0), Point::new(12.0, 12.0)));
    /// ```
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
                let enters = |(a, b): (Point, Point)| {
                    let size = (high - low).min();
                    let steps = ((b - a).norm() / size * 2.0).ceil().clamp(1.0, 1e4) as usize;
                    (0..=steps).any(|k| in_box(&(a + (b - a) * (k as f64 / steps as f64))))
                };
                corners.iter().chain([&middle]).any(|p| shape::ring_contains(vertices, *p))
                    || polyline::edges(vertices).any(enters)
            }
        }
    }

    /// Area of the floor within the wall, obstacles included, square metres.
    ///
    /// ```
    /// let tank: geometry::Boundary = geometry::Boundary::Circle { radius_m: 2.0 };
    /// assert!((tank.area_m2() - 12.566).abs() < 1e-3);
    /// ```
    pub fn area_m2(&self) -> f64 {
        match self {
            Self::Circle { radius_m } => std::f64::consts::PI * radius_m * radius_m,
            Self::Polygon { vertices } => shape::ring_area_m2(vertices.as_ref()).abs(),
        }
    }
}
