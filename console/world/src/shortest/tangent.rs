//! Common tangents of the circles that paths turn about.

use super::bar::TOUCH_M;
use geometry::{Point, Vector};

/// A circle, and the direction in which a path turns about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turn {
    pub center: Point,
    /// Radius, metres: positive for counter-clockwise, negative for clockwise, zero for an end of the path.
    pub signed_m: f64,
}

/// A segment that leaves one circle and reaches another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tangent {
    pub from: Point,
    pub to: Point,
    pub length_m: f64,
    /// Unit vectors from the first centre to `from` and from the second to `to`.
    pub leave: Vector,
    pub meet: Vector,
}

/// Returns the tangent along which a path goes from one turn to another; `None` if the circles are too close together.
///
/// With the vector `e` between the centres and the signed radii `s`, the tangent runs at an angle
/// `asin((s_j - s_i) / |e|)` to `e`.
pub(super) fn tangent(i: Turn, j: Turn) -> Option<Tangent> {
    let way = j.center - i.center;
    let squared = way.norm_squared();
    let grown_m = j.signed_m - i.signed_m;
    let length_squared = squared - grown_m * grown_m;
    // An end of the path may lie on the circle, to within rounding errors; the path then leaves along the circle.
    if length_squared <= -4.0 * TOUCH_M * grown_m.abs() || squared == 0.0 {
        return None;
    }
    let length_m = length_squared.max(0.0).sqrt();
    let along = (way * length_m - Vector::new(-way.y, way.x) * grown_m) / squared;
    let left = Vector::new(-along.y, along.x);
    Some(Tangent {
        from: i.center - left * i.signed_m,
        to: j.center - left * j.signed_m,
        length_m,
        leave: -left * i.signed_m.signum(),
        meet: -left * j.signed_m.signum(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn turn() -> impl Strategy<Value = Turn> {
        (-9.0..9.0_f64, -9.0..9.0_f64, -2.0..2.0_f64)
            .prop_map(|(x, y, signed_m)| Turn { center: Point::new(x, y), signed_m })
    }

    proptest! {
        #[test]
        fn a_tangent_touches_both_circles_on_the_side_of_the_turn(i in turn(), j in turn()) {
            prop_assume!((i.center - j.center).norm() > 4.0);
            let found = tangent(i, j).unwrap();
            let along = found.to - found.from;
            prop_assert!((along.norm() - found.length_m).abs() < 1e-9);
            for (circle, at) in [(i, found.from), (j, found.to)] {
                let to_center = circle.center - at;
                // The centre of a counter-clockwise turn is on the left, at the distance of the radius and
                // perpendicular to the path.
                prop_assert!((along.perp(&to_center) / found.length_m - circle.signed_m).abs() < 1e-9);
                prop_assert!(along.dot(&to_center).abs() < 1e-8);
            }
        }
    }
}
