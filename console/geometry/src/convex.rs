//! Decomposes shapes into convex parts, with signed distances, gaps and outward directions.

use crate::{
    Point, Shape, Vector, direction_or,
    polyline::{edges, nearest_on_segment},
    shape::mean_of,
};

/// A convex part of a shape.
///
/// ```
/// use geometry::{Point, convex::Part};
/// let pipe = Part::Capsule { a: Point::new(0.0, 0.0), b: Point::new(4.0, 0.0), half_width_m: 0.1 };
/// assert_eq!(pipe.distance(Point::new(2.0, 1.0)).0, 0.9);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum Part {
    /// Everything within `half_width_m` of a segment; a disc if both ends coincide.
    Capsule {
        /// One end.
        a: Point,
        /// The other end.
        b: Point,
        /// Half the thickness, metres.
        half_width_m: f64,
    },
    /// A convex polygon, counter-clockwise.
    Polygon {
        /// Corners.
        vertices: Vec<Point>,
    },
}

/// The shortest segment between two parts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// Length of the segment, metres; zero or negative if the parts touch.
    pub width_m: f64,
    /// End of the segment on the first part: on the centre line (capsule) or on the edge (polygon).
    pub from: Point,
    /// End of the segment on the second part: on the centre line (capsule) or on the edge (polygon).
    pub to: Point,
}

/// The convex parts of a shape: one, or one for each segment of a polyline.
///
/// ```
/// use geometry::{Point, Shape, convex::parts_of};
/// let points = vec![Point::new(0.0, 0.0), Point::new(4.0, 0.0), Point::new(4.0, 3.0)];
/// assert_eq!(parts_of(&Shape::Polyline { points, half_width_m: 0.1 }).len(), 2);
/// ```
pub fn parts_of<P: AsRef<[Point]>>(shape: &Shape<P>) -> Vec<Part> {
    match shape.as_ref() {
        Shape::Disc { center, radius_m } => vec![Part::disc(center, radius_m)],
        Shape::Polygon { vertices } => vec![Part::Polygon { vertices: vertices.to_vec() }],
        Shape::Polyline { points, half_width_m } => {
            points.windows(2).map(|w| Part::Capsule { a: w[0], b: w[1], half_width_m }).collect()
        }
    }
}

impl Part {
    /// A disc with a radius in metres.
    ///
    /// ```
    /// use geometry::{Point, convex::Part};
    /// assert_eq!(Part::disc(Point::new(2.0, 0.0), 0.5).middle(), Point::new(2.0, 0.0));
    /// ```
    pub fn disc(center: Point, radius_m: f64) -> Self {
        Self::Capsule { a: center, b: center, half_width_m: radius_m }
    }

    /// A line without thickness.
    ///
    /// ```
    /// use geometry::{Point, convex::Part};
    /// let line = Part::segment(Point::new(0.0, 0.0), Point::new(2.0, 0.0));
    /// assert_eq!(line.distance(Point::new(1.0, 0.5)).0, 0.5);
    /// ```
    pub fn segment(a: Point, b: Point) -> Self {
        Self::Capsule { a, b, half_width_m: 0.0 }
    }

    /// The part as a shape.
    ///
    /// ```
    /// use geometry::{Point, Shape, convex::Part};
    /// let center = Point::new(2.0, 0.0);
    /// assert_eq!(Part::disc(center, 0.5).to_shape(), Shape::Disc { center, radius_m: 0.5 });
    /// ```
    pub fn to_shape(&self) -> Shape {
        match self {
            Self::Capsule { a, b, half_width_m } if a == b => {
                Shape::Disc { center: *a, radius_m: *half_width_m }
            }
            Self::Capsule { a, b, half_width_m } => {
                Shape::Polyline { points: vec![*a, *b], half_width_m: *half_width_m }
            }
            Self::Polygon { vertices } => Shape::Polygon { vertices: vertices.clone() },
        }
    }

    /// Signed distance from a point to the outline, metres (negative inside), and the outward unit vector there.
    ///
    /// ```
    /// use geometry::{Point, Vector, convex::Part};
    /// let column = Part::disc(Point::origin(), 0.5);
    /// assert_eq!(column.distance(Point::new(2.0, 0.0)), (1.5, Vector::x()));
    /// ```
    pub fn distance(&self, point: Point) -> (f64, Vector) {
        match self {
            Self::Capsule { a, b, half_width_m } => {
                let from_line = point - nearest_on_segment(*a, *b, point);
                let across = Vector::new(a.y - b.y, b.x - a.x);
                let away = direction_or(from_line, direction_or(across, Vector::x()));
                (from_line.norm() - half_width_m, away)
            }
            Self::Polygon { vertices } => {
                let (closest, distance_m) = nearest_on_ring(vertices, point);
                let signed_m = if is_inside(vertices, point) { -distance_m } else { distance_m };
                (signed_m, away_from(point, signed_m, closest, mean_of(vertices)))
            }
        }
    }

    /// A point inside the part: the middle of a capsule, or the mean of a polygon's corners.
    ///
    /// ```
    /// use geometry::{Point, convex::Part};
    /// let pipe = Part::Capsule { a: Point::new(0.0, 0.0), b: Point::new(4.0, 0.0), half_width_m: 0.1 };
    /// assert_eq!(pipe.middle(), Point::new(2.0, 0.0));
    /// ```
    pub fn middle(&self) -> Point {
        match self {
            Self::Capsule { a, b, .. } => nalgebra::center(a, b),
            Self::Polygon { vertices } => mean_of(vertices),
        }
    }

    /// Distance from a segment to the outline, metres; zero or negative if they touch.
    ///
    /// ```
    /// use geometry::{Point, convex::Part};
    /// let column = Part::disc(Point::new(0.0, 2.0), 0.5);
    /// assert_eq!(column.segment_distance_m(Point::new(-3.0, 0.0), Point::new(3.0, 0.0)), 1.5);
    /// ```
    pub fn segment_distance_m(&self, a: Point, b: Point) -> f64 {
        if let Self::Capsule { a: center, b: other, half_width_m } = self
            && center == other
        {
            return (center - nearest_on_segment(a, b, *center)).norm() - half_width_m;
        }
        let inside = matches!(self, Self::Polygon { vertices } if is_inside(vertices, a));
        if inside { 0.0 } else { self.gap(&Self::segment(a, b)).width_m }
    }

    /// The shortest segment from this part to another; neither may contain the other.
    ///
    /// ```
    /// use geometry::{Point, convex::Part};
    /// let gap = Part::disc(Point::new(0.0, 0.0), 0.5).gap(&Part::disc(Point::new(3.0, 0.0), 1.0));
    /// assert_eq!((gap.width_m, gap.to), (1.5, Point::new(3.0, 0.0)));
    /// ```
    pub fn gap(&self, other: &Self) -> Gap {
        let mut best = Gap { width_m: f64::INFINITY, from: Point::origin(), to: Point::origin() };
        for (a, b) in self.pieces() {
            for (c, d) in other.pieces() {
                let (from, to) = closest_of_segments(a, b, c, d);
                let width_m = (to - from).norm() - self.half_width_m() - other.half_width_m();
                if width_m < best.width_m {
                    best = Gap { width_m, from, to };
                }
            }
        }
        best
    }

    /// Discs, each given by its centre and its radius in metres, whose convex hull is the part.
    ///
    /// ```
    /// use geometry::{Point, convex::Part};
    /// let pipe = Part::Capsule { a: Point::new(0.0, 0.0), b: Point::new(4.0, 0.0), half_width_m: 0.1 };
    /// assert_eq!(pipe.corners()[1], (Point::new(4.0, 0.0), 0.1));
    /// ```
    pub fn corners(&self) -> Vec<(Point, f64)> {
        match self {
            Self::Capsule { a, b, half_width_m } => vec![(*a, *half_width_m), (*b, *half_width_m)],
            Self::Polygon { vertices } => vertices.iter().map(|v| (*v, 0.0)).collect(),
        }
    }

    fn half_width_m(&self) -> f64 {
        match self {
            Self::Capsule { half_width_m, .. } => *half_width_m,
            Self::Polygon { .. } => 0.0,
        }
    }

    /// The centre line of a capsule, or the edges of a polygon.
    fn pieces(&self) -> impl Iterator<Item = (Point, Point)> + '_ {
        let (line, ring): (_, &[Point]) = match self {
            Self::Capsule { a, b, .. } => (Some((*a, *b)), &[]),
            Self::Polygon { vertices } => (None, vertices),
        };
        line.into_iter().chain(edges(ring))
    }
}

fn nearest_on_ring(vertices: &[Point], point: Point) -> (Point, f64) {
    edges(vertices)
        .map(|(a, b)| nearest_on_segment(a, b, point))
        .map(|closest| (closest, (point - closest).norm()))
        .min_by(|x, y| x.1.total_cmp(&y.1))
        .unwrap_or((point, f64::INFINITY))
}

/// Whether a point is inside a convex polygon.
fn is_inside(vertices: &[Point], point: Point) -> bool {
    vertices.len() > 2 && edges(vertices).all(|(a, b)| (b - a).perp(&(point - a)) > 0.0)
}

/// The nearest points on two segments; where the segments cross, both are the crossing point.
fn closest_of_segments(a: Point, b: Point, c: Point, d: Point) -> (Point, Point) {
    if let Some(crossing) = crossing(a, b, c, d) {
        return (crossing, crossing);
    }
    let pairs = [
        (a, nearest_on_segment(c, d, a)),
        (b, nearest_on_segment(c, d, b)),
        (nearest_on_segment(a, b, c), c),
        (nearest_on_segment(a, b, d), d),
    ];
    let shorter =
        |x: (Point, Point), y: (Point, Point)| if (y.1 - y.0).norm() < (x.1 - x.0).norm() { y } else { x };
    pairs.into_iter().reduce(shorter).expect("there are four pairs")
}

/// Outward unit vector of an outline at a point: along the line through `point` and `closest`, which is the nearest point
/// on the outline.
///
/// `signed_m` is the distance from the point to the outline, metres, negative inside. On the outline itself, where
/// `point` and `closest` coincide, the vector points away from `center`, a point inside.
///
/// ```
/// use geometry::{Point, Vector, convex::away_from};
/// let (center, closest) = (Point::origin(), Point::new(1.0, 0.0));
/// assert_eq!(away_from(Point::new(0.5, 0.0), -0.5, closest, center), Vector::x());
/// assert_eq!(away_from(closest, 0.0, closest, center), Vector::x());
/// ```
pub fn away_from(point: Point, signed_m: f64, closest: Point, center: Point) -> Vector {
    let outward = (point - closest) * signed_m.signum();
    let from_center = direction_or(point - center, Vector::x());
    direction_or(outward, from_center)
}

/// The point at which two segments meet, which may be an end; `None` for parallel segments.
///
/// ```
/// use geometry::{Point, convex::crossing};
/// let (a, b) = (Point::new(-1.0, 0.0), Point::new(1.0, 0.0));
/// let up = crossing(a, b, Point::new(0.5, -1.0), Point::new(0.5, 1.0));
/// assert_eq!(up, Some(Point::new(0.5, 0.0)));
/// ```
pub fn crossing(a: Point, b: Point, c: Point, d: Point) -> Option<Point> {
    let (along, across) = (b - a, d - c);
    let turn = along.perp(&across);
    if turn.abs() < 1e-12 {
        return None;
    }
    let share = (c - a).perp(&across) / turn;
    let other = (c - a).perp(&along) / turn;
    let on_both = (0.0..=1.0).contains(&share) && (0.0..=1.0).contains(&other);
    on_both.then(|| a + along * share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::tests::any_shape;
    use proptest::prelude::*;

    fn disc(x: f64, y: f64, radius_m: f64) -> Part {
        Part::disc(Point::new(x, y), radius_m)
    }

    fn square() -> Part {
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        Part::Polygon { vertices: corners.iter().map(|(x, y)| Point::new(*x, *y)).collect() }
    }

    #[test]
    fn the_gap_between_discs_is_what_is_left_of_their_distance() {
        let gap = disc(0.0, 0.0, 0.5).gap(&disc(3.0, 0.0, 1.0));
        assert!((gap.width_m - 1.5).abs() < 1e-12);
        assert!((square().gap(&disc(4.0, 1.0, 0.5)).width_m - 1.5).abs() < 1e-12);
    }

    #[test]
    fn distances_to_a_square_are_signed_and_point_outward() {
        let (inside_m, out) = square().distance(Point::new(1.9, 1.0));
        assert!((inside_m + 0.1).abs() < 1e-12 && (out - Vector::x()).norm() < 1e-12);
        let (outside_m, out) = square().distance(Point::new(2.5, 1.0));
        assert!((outside_m - 0.5).abs() < 1e-12 && (out - Vector::x()).norm() < 1e-12);
    }

    #[test]
    fn a_segment_through_a_part_has_no_distance_to_it() {
        let (a, b) = (Point::new(-1.0, 1.0), Point::new(3.0, 1.0));
        assert!(square().segment_distance_m(a, b) <= 0.0);
        assert!((disc(1.0, 3.0, 0.5).segment_distance_m(a, b) - 1.5).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn outside_the_nearest_part_is_as_far_as_the_shape(shape in any_shape(), x in -9.0..9.0_f64, y in -9.0..9.0_f64) {
            let point = Point::new(x, y);
            prop_assume!(shape.distance_m(point) > 0.0);
            let parts = parts_of(&shape);
            let nearest_m = parts.iter().map(|part| part.distance(point).0).fold(f64::INFINITY, f64::min);
            prop_assert!((nearest_m - shape.distance_m(point)).abs() < 1e-9);
        }

        #[test]
        fn a_part_is_the_only_part_of_its_shape(shape in any_shape()) {
            for part in parts_of(&shape) {
                prop_assert_eq!(parts_of(&part.to_shape()), [part]);
            }
        }
    }

    #[test]
    fn the_way_out_points_outward_inside_on_and_outside_the_outline() {
        let center = Point::origin();
        let closest = Point::new(1.0, 0.0);
        for (x, signed_m) in [(0.5, -0.5), (1.0, 0.0), (1.5, 0.5)] {
            assert!((away_from(Point::new(x, 0.0), signed_m, closest, center) - Vector::x()).norm() < 1e-12);
        }
        assert!((away_from(center, 0.0, center, center).norm() - 1.0).abs() < 1e-12);
    }
}
