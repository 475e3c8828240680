//! Tangents from a robot to a round or convex solid.

use crate::side::Side;
use geometry::{Point, Vector};

/// A tangent: its direction and its length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tangent {
    /// Unit vector from the robot along the tangent.
    pub direction: Vector,
    /// Length up to the point of contact, metres; 0 when the robot is on or inside the outline.
    pub length_m: f64,
}

/// The tangent from `at` to a disc on one side (Xu et al. 2022, eq. 10). The printed form is singular where the tangent
/// is vertical; written with vectors, it is `(L c +- R c') / |c|^2`.
///
/// From inside the disc, the tangent points along the circle and slightly outward.
pub fn to_disc(at: Point, center: Point, radius_m: f64, side: Side) -> Tangent {
    let c = center - at;
    let across = Vector::new(-c.y, c.x) * side.sign();
    let squared = c.norm_squared();
    let length_squared = squared - radius_m * radius_m;
    if length_squared > 0.0 {
        let length_m = length_squared.sqrt();
        return Tangent { direction: (c * length_m + across * radius_m) / squared, length_m };
    }
    let distance_m = squared.sqrt();
    if distance_m < 1e-9 {
        return Tangent { direction: Vector::x(), length_m: 0.0 };
    }
    let outward = 0.3 * (1.0 - distance_m / radius_m).min(1.0) + 0.02;
    let direction = (across - c * outward).normalize();
    Tangent { direction, length_m: 0.0 }
}

/// The outermost tangent to several discs on one side; `None` if there are no discs. Seen from `at`, the discs must lie
/// within half a turn.
pub fn outermost(at: Point, discs: impl Iterator<Item = (Point, f64)>, side: Side) -> Option<Tangent> {
    discs.map(|(center, radius_m)| to_disc(at, center, radius_m, side)).reduce(|best, next| {
        if best.direction.perp(&next.direction) * side.sign() > 0.0 { next } else { best }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_tangent_touches_the_disc_on_its_side(
            bearing in 0.0..6.3_f64, distance in 1.1..30.0_f64, radius in 0.1..1.0_f64,
        ) {
            let center = Point::new(bearing.cos(), bearing.sin()) * distance;
            for side in [Side::Left, Side::Right] {
                let tangent = to_disc(Point::origin(), center, radius, side);
                let touch = Point::from(tangent.direction * tangent.length_m);
                prop_assert!(((touch - center).norm() - radius).abs() < 1e-9);
                prop_assert!((tangent.direction.norm() - 1.0).abs() < 1e-9);
                prop_assert!(center.coords.perp(&tangent.direction) * side.sign() > 0.0);
            }
        }
    }

    #[test]
    fn from_inside_it_leads_round_and_out() {
        let tangent = to_disc(Point::new(-0.5, 0.0), Point::origin(), 1.0, Side::Left);
        assert!(tangent.direction.y > 0.9 && tangent.direction.x < 0.0);
        assert!(to_disc(Point::origin(), Point::origin(), 1.0, Side::Left).direction.norm() > 0.9);
    }

    #[test]
    fn the_outermost_of_several_is_the_hulls() {
        let discs = [(Point::new(5.0, 0.0), 0.5), (Point::new(5.0, 3.0), 0.5), (Point::new(9.0, 4.0), 0.5)];
        let left = outermost(Point::origin(), discs.into_iter(), Side::Left).map(|t| t.direction);
        let alone = to_disc(Point::origin(), Point::new(5.0, 3.0), 0.5, Side::Left).direction;
        assert_eq!(left, Some(alone));
    }
}
