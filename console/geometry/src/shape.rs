//! Outlines of obstacles and zones.

use crate::{
    Point, Vector,
    polyline::{self, edges},
};
use nalgebra::Isometry2;

/// The outline of an obstacle or a zone, tank frame unless stated otherwise.
///
/// `P` is the storage of the corners: `Shape` owns them, `Shape<&[Point]>` borrows them, as planners do.
///
/// ```
/// use geometry::{Point, Shape};
/// let pipe: Shape = Shape::Polyline { points: vec![Point::new(0.0, 0.0), Point::new(4.0, 0.0)], half_width_m: 0.1 };
/// assert_eq!(pipe.distance_m(Point::new(2.0, 1.0)), 0.9);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Shape<P = Vec<Point>> {
    /// A round column or pipe.
    Disc {
        /// Centre, metres.
        center: Point,
        /// Radius, metres; zero for the point obstacles in the papers.
        radius_m: f64,
    },
    /// A convex polygon, counter-clockwise.
    Polygon {
        /// Corners, metres.
        vertices: P,
    },
    /// A pipe or a wall: everything within half its thickness of a chain of segments.
    Polyline {
        /// Corners of the centre line, metres.
        points: P,
        /// Half the thickness, metres.
        half_width_m: f64,
    },
}

impl<P: AsRef<[Point]>> Shape<P> {
    /// The same shape with borrowed corners.
    ///
    /// ```
    /// use geometry::{Point, Shape};
    /// let corners = vec![Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(0.0, 1.0)];
    /// let shape = Shape::Polygon { vertices: corners.clone() };
    /// assert_eq!(shape.as_ref(), Shape::Polygon { vertices: &corners[..] });
    /// ```
    pub fn as_ref(&self) -> Shape<&[Point]> {
        match self {
            Self::Disc { center, radius_m } => Shape::Disc { center: *center, radius_m: *radius_m },
            Self::Polygon { vertices } => Shape::Polygon { vertices: vertices.as_ref() },
            Self::Polyline { points, half_width_m } => {
                Shape::Polyline { points: points.as_ref(), half_width_m: *half_width_m }
            }
        }
    }

    /// The same shape with owned corners.
    ///
    /// ```
    /// use geometry::{Point, Shape};
    /// let corners = [Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(0.0, 1.0)];
    /// let shape = Shape::Polygon { vertices: &corners[..] }.to_owned();
    /// assert_eq!(shape, Shape::Polygon { vertices: corners.to_vec() });
    /// ```
    pub fn to_owned(&self) -> Shape {
        self.map(|point| *point)
    }

    /// The same shape after a rigid motion, for example from the robot frame to the tank frame.
    ///
    /// ```
    /// use geometry::{Point, Pose, Shape};
    /// let ahead: Shape = Shape::Disc { center: Point::new(2.0, 0.0), radius_m: 0.5 };
    /// let north = Pose::new(1.0, 0.0, std::f64::consts::FRAC_PI_2);
    /// let in_tank = ahead.transformed(&north.tank_from_robot());
    /// assert!((in_tank.center() - Point::new(1.0, 2.0)).norm() < 1e-12);
    /// ```
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

    /// The centre of a disc, or the mean of the corners of any other shape.
    ///
    /// ```
    /// use geometry::{Point, Shape};
    /// let pipe = Shape::Polyline { points: vec![Point::new(0.0, 0.0), Point::new(4.0, 2.0)], half_width_m: 0.1 };
    /// assert_eq!(pipe.center(), Point::new(2.0, 1.0));
    /// ```
    pub fn center(&self) -> Point {
        match self {
            Self::Disc { center, .. } => *center,
            Self::Polygon { vertices: points } | Self::Polyline { points, .. } => mean_of(points.as_ref()),
        }
    }

    /// Distance from a point to the outline, metres; negative inside. Inside a bend of a polyline, the depth relative to
    /// the nearer segment alone counts.
    ///
    /// ```
    /// use geometry::{Point, Shape};
    /// let column: Shape = Shape::Disc { center: Point::origin(), radius_m: 0.5 };
    /// assert_eq!(column.distance_m(Point::new(3.0, 4.0)), 4.5);
    /// assert_eq!(column.distance_m(Point::origin()), -0.5);
    /// ```
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

    /// The smallest axis-aligned box around the shape: its south-west and north-east corners.
    ///
    /// ```
    /// use geometry::{Point, Shape};
    /// let column: Shape = Shape::Disc { center: Point::new(2.0, 0.0), radius_m: 0.5 };
    /// assert_eq!(column.bounds(), (Point::new(1.5, -0.5), Point::new(2.5, 0.5)));
    /// ```
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

/// The mean of some points; the origin if there are none.
///
/// ```
/// use geometry::{Point, shape::mean_of};
/// assert_eq!(mean_of(&[Point::new(0.0, 0.0), Point::new(2.0, 4.0)]), Point::new(1.0, 2.0));
/// ```
pub fn mean_of(points: &[Point]) -> Point {
    let sum: Vector = points.iter().map(|p| p.coords).sum();
    Point::from(sum / points.len().max(1) as f64)
}

/// The smallest axis-aligned box around some points: its south-west and north-east corners. If there are no points, the
/// corners are at infinity, the first beyond the second.
///
/// ```
/// use geometry::{Point, shape::bounds_of};
/// let (low, high) = bounds_of(&[Point::new(0.0, 3.0), Point::new(2.0, -1.0)]);
/// assert_eq!((low, high), (Point::new(0.0, -1.0), Point::new(2.0, 3.0)));
/// ```
pub fn bounds_of(points: &[Point]) -> (Point, Point) {
    let far = f64::INFINITY;
    points
        .iter()
        .fold((Point::new(far, far), Point::new(-far, -far)), |(low, high), p| (low.inf(p), high.sup(p)))
}

/// Whether a point is inside a simple polygon, decided by the crossing number; for a point on an edge the result is
/// unspecified.
///
/// ```
/// use geometry::{Point, shape::{rectangle, ring_contains}};
/// let square = rectangle(Point::new(0.0, 0.0), Point::new(2.0, 2.0));
/// assert!(ring_contains(&square, Point::new(1.0, 1.0)));
/// assert!(!ring_contains(&square, Point::new(3.0, 1.0)));
/// ```
pub fn ring_contains(vertices: &[Point], point: Point) -> bool {
    edges(vertices).fold(false, |inside, (a, b)| {
        let crosses =
            (a.y > point.y) != (b.y > point.y) && point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x;
        inside != crosses
    })
}

/// The corners of a box, counter-clockwise from the south-west one, given its south-west and north-east corners.
///
/// ```
/// use geometry::{Point, shape::rectangle};
/// assert_eq!(rectangle(Point::new(0.0, 0.0), Point::new(3.0, 2.0))[1], Point::new(3.0, 0.0));
/// ```
pub fn rectangle(low: Point, high: Point) -> Vec<Point> {
    vec![low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)]
}

/// Signed area of a simple polygon, square metres, positive when counter-clockwise (shoelace formula).
///
/// ```
/// use geometry::{Point, shape::{rectangle, ring_area_m2}};
/// assert_eq!(ring_area_m2(&rectangle(Point::new(0.0, 0.0), Point::new(3.0, 2.0))), 6.0);
/// ```
pub fn ring_area_m2(vertices: &[Point]) -> f64 {
    edges(vertices).map(|(a, b)| a.coords.perp(&b.coords)).sum::<f64>() / 2.0
}

/// Indices of the corners at which a simple polygon, of either orientation, has an interior angle above 180 degrees.
///
/// ```
/// use geometry::{Point, shape::reflex_corners};
/// let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 2.0), (0.0, 4.0)];
/// let ring = corners.map(|(x, y)| Point::new(x, y));
/// assert_eq!(reflex_corners(&ring).collect::<Vec<_>>(), [3]);
/// ```
pub fn reflex_corners(vertices: &[Point]) -> impl Iterator<Item = usize> + '_ {
    let (n, sense) = (vertices.len(), ring_area_m2(vertices).signum());
    (0..n).filter(move |&k| {
        let (before, here, after) = (vertices[(k + n - 1) % n], vertices[k], vertices[(k + 1) % n]);
        sense * (here - before).perp(&(after - here)) < 0.0
    })
}

/// Returns the convex hull of points, counter-clockwise, without collinear corners (Andrew's monotone chain).
///
/// ```
/// use geometry::{Point, shape::convex_hull};
/// let points = [(0.0, 0.0), (1.0, 0.0), (0.5, 0.2), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y));
/// assert_eq!(convex_hull(&points).len(), 4);
/// ```
pub fn convex_hull(points: &[Point]) -> Vec<Point> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let chain = |points: &mut dyn Iterator<Item = &Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for point in points {
            while let [.., a, b] = &chain[..]
                && (b - a).perp(&(point - b)) <= 1e-9
            {
                chain.pop();
            }
            chain.push(*point);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut sorted.iter());
    hull.extend(chain(&mut sorted.iter().rev()));
    hull
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Discs, boxes and pipes with a bend.
    pub(crate) fn any_shape() -> impl Strategy<Value = Shape> {
        let at = || (-8.0..8.0_f64, -8.0..8.0_f64).prop_map(|(x, y)| Point::new(x, y));
        let size = || (0.1..3.0_f64, 0.1..3.0_f64).prop_map(|(x, y)| Vector::new(x, y));
        prop_oneof![
            (at(), 0.0..1.0_f64).prop_map(|(center, radius_m)| Shape::Disc { center, radius_m }),
            (at(), size()).prop_map(|(low, size)| Shape::Polygon { vertices: rectangle(low, low + size) }),
            ([at(), at(), at()], 0.01..0.5_f64)
                .prop_map(|(points, half_width_m)| Shape::Polyline { points: points.to_vec(), half_width_m }),
        ]
    }

    proptest! {
        #[test]
        fn a_borrowed_shape_is_the_same_shape(shape in any_shape(), x in -9.0..9.0_f64, y in -9.0..9.0_f64) {
            let point = Point::new(x, y);
            prop_assert_eq!(shape.as_ref().distance_m(point).to_bits(), shape.distance_m(point).to_bits());
            prop_assert_eq!(shape.as_ref().bounds(), shape.bounds());
            prop_assert_eq!(shape.as_ref().to_owned(), shape);
        }

        #[test]
        fn a_rigid_motion_keeps_distances(
            shape in any_shape(), at in (-9.0..9.0_f64, -9.0..9.0_f64), angle in -4.0..4.0_f64,
        ) {
            let (point, motion) = (Point::new(at.0, at.1), Isometry2::new(Vector::new(at.1, at.0), angle));
            let moved_m = shape.transformed(&motion).distance_m(motion * point);
            prop_assert!((moved_m - shape.distance_m(point)).abs() < 1e-9);
        }

        #[test]
        fn no_point_of_a_shape_lies_outside_its_box(shape in any_shape(), x in -12.0..12.0_f64, y in -12.0..12.0_f64) {
            let ((low, high), point) = (shape.bounds(), Point::new(x, y));
            prop_assert!(shape.distance_m(point) > 0.0 || point.sup(&low).inf(&high) == point);
        }
    }

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
