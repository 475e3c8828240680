//! The outlines of no-go zones that an operator can draw.

use geometry::unit_vector;
use world::{
    Point, Shape,
    shape::{rectangle, ring_area_m2},
};

/// Number of corners of a circle.
const CIRCLE_CORNERS: u32 = 24;
/// The largest distance between corners that count as equal, metres: corners in a journal are rounded.
const SAME_M: f64 = 1e-3;

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

/// The corners counter-clockwise, metres, tank frame, as a [`Shape::Polygon`] needs them.
pub fn turned(corners: &[Point]) -> Vec<Point> {
    let mut turned = corners.to_vec();
    if ring_area_m2(corners) < 0.0 {
        turned.reverse();
    }
    turned
}

/// The outline with these corners in words: its form, size and place, metres, tank frame.
///
/// ```
/// use mission::outline::{boxed, round, words};
/// use world::Point;
/// assert_eq!(words(&round(Point::new(2.0, 0.0), 0.75)), "circle of radius 0.75 m at 2.00, 0.00 m");
/// assert_eq!(words(&boxed(Point::new(1.0, 2.0), Point::new(3.0, 4.0))), "box 1.00, 2.00 to 3.00, 4.00 m");
/// ```
pub fn words(corners: &[Point]) -> String {
    let turned = turned(corners);
    let Some(first) = turned.first().copied() else { return "no outline".into() };
    let (low, high) = turned.iter().fold((first, first), |(low, high), at| (low.inf(at), high.sup(at)));
    let center = nalgebra::center(&low, &high);
    let size = format!("{:.2}, {:.2} to {:.2}, {:.2} m", low.x, low.y, high.x, high.y);
    let radius_m = Shape::Polygon { vertices: turned.as_slice() }.distance_m(center).abs();
    if is_same(&turned, &round(center, radius_m)) {
        format!("circle of radius {radius_m:.2} m at {:.2}, {:.2} m", center.x, center.y)
    } else if is_same(&turned, &boxed(low, high)) {
        format!("box {size}")
    } else {
        format!("polygon with {} corners, {size}", turned.len())
    }
}

/// The outline of a shape in words: its form, size and place, metres, tank frame.
pub fn of(shape: &Shape) -> String {
    match shape {
        Shape::Disc { center, radius_m } => {
            format!("circle of radius {radius_m:.2} m at {:.2}, {:.2} m", center.x, center.y)
        }
        Shape::Polygon { vertices } => words(vertices),
        Shape::Polyline { .. } => {
            let (low, high) = shape.bounds();
            format!("{:.2}, {:.2} to {:.2}, {:.2} m", low.x, low.y, high.x, high.y)
        }
    }
}

/// Whether two outlines have the same corners, from whichever corner they begin.
fn is_same(one: &[Point], other: &[Point]) -> bool {
    let has = |corner: &Point| other.iter().any(|same| (same - corner).norm() < SAME_M);
    one.len() == other.len() && one.iter().all(has)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_is_named_by_its_form() {
        let mut circle = round(Point::new(-1.0, 2.5), 0.75);
        circle.reverse();
        circle.rotate_left(5);
        assert_eq!(words(&circle), "circle of radius 0.75 m at -1.00, 2.50 m");
        let five = [(0.0, 0.0), (2.0, 0.0), (3.0, 1.0), (1.0, 2.0), (-0.5, 1.0)];
        let five = five.map(|(x, y)| Point::new(x, y));
        assert_eq!(words(&five), "polygon with 5 corners, -0.50, 0.00 to 3.00, 2.00 m");
        let skew = [(0.0, 0.0), (2.0, 0.5), (2.0, 2.0), (0.0, 2.0)].map(|(x, y)| Point::new(x, y));
        assert!(words(&skew).starts_with("polygon with 4 corners"));
    }
}
