//! The outlines of no-go zones that an operator can draw.

use geometry::unit_vector;
use world::{Point, shape::rectangle};

/// Number of corners of a circle.
const CIRCLE_CORNERS: u32 = 24;

/// The corners of the box with these two opposite corners, metres, tank frame, for
/// [`Order::DrawZone`](crate::Order::DrawZone).
///
/// ```
/// use mission::outline::boxed;
/// use world::Point;
/// let corners = boxed(Point::new(3.0, 1.0), Point::new(1.0, 2.0));
/// assert_eq!((corners[0], corners[2]), (Point::new(1.0, 1.0), Point::new(3.0, 2.0)));
/// ```
pub fn boxed(corner: Point, opposite: Point) -> Vec<Point> {
    rectangle(corner.inf(&opposite), corner.sup(&opposite))
}

/// The corners of a regular polygon around a circle, metres, tank frame: the whole circle is inside, and the polygon
/// exceeds it by less than 1 % of the radius.
///
/// ```
/// use mission::outline::round;
/// use world::{Point, Shape};
/// let zone = Shape::Polygon { vertices: round(Point::new(2.0, 0.0), 1.0) };
/// assert!(zone.distance_m(Point::new(3.0, 0.0)) < 1e-9 && zone.distance_m(Point::new(3.01, 0.0)) > 0.0);
/// ```
pub fn round(center: Point, radius_m: f64) -> Vec<Point> {
    let step_rad = std::f64::consts::TAU / f64::from(CIRCLE_CORNERS);
    let corner_m = radius_m / (0.5 * step_rad).cos();
    (0..CIRCLE_CORNERS).map(|k| center + unit_vector(step_rad * (f64::from(k) + 0.5)) * corner_m).collect()
}
