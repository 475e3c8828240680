//! Plane geometry shared by several planning steps.

use geometry::convex::crossing;
use world::{Boundary, Point, Vector};

/// The unit vector at an angle, radians from east.
pub(crate) fn direction(angle_rad: f64) -> Vector {
    Vector::new(angle_rad.cos(), angle_rad.sin())
}

/// A vector turned left by a right angle.
pub(crate) fn left_of(ahead: Vector) -> Vector {
    Vector::new(-ahead.y, ahead.x)
}

/// The angle between two unit vectors, radians, from 0 to pi.
pub(crate) fn angle_rad(a: Vector, b: Vector) -> f64 {
    a.perp(&b).atan2(a.dot(&b)).abs()
}

/// The minimum and maximum of some numbers; plus and minus infinity if there are none.
pub(crate) fn extent(numbers: impl Iterator<Item = f64>) -> (f64, f64) {
    numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), n| (low.min(n), high.max(n)))
}

/// The direction in which the wall recedes fastest.
pub(crate) fn inward(wall: &Boundary, at: Point) -> Vector {
    let step = 1e-4;
    let d = |offset: Vector| wall.wall_distance_m(at + offset);
    let slope = Vector::new(
        d(Vector::new(step, 0.0)) - d(Vector::new(-step, 0.0)),
        d(Vector::new(0.0, step)) - d(Vector::new(0.0, -step)),
    );
    slope.try_normalize(1e-12).unwrap_or_else(Vector::x)
}

/// Whether the straight path between two points meets a line.
pub(crate) fn meets(line: &[Point], a: Point, b: Point) -> bool {
    line.windows(2).any(|side| crossing(a, b, side[0], side[1]).is_some())
}

/// Length and turning of a path.
#[derive(Clone, Copy)]
pub(crate) struct Course {
    /// Length, metres.
    pub length_m: f64,
    /// Sum of the changes of heading, radians.
    pub turn_rad: f64,
}

impl Course {
    /// Measures a path, including the turns at its ends if the headings before and after are known.
    pub(crate) fn of(entered: Option<Vector>, way: &[Point], left: Option<Vector>) -> Self {
        let (mut heading, mut length_m, mut turn_rad) = (entered, 0.0, 0.0);
        for leg in way.windows(2).map(|w| w[1] - w[0]) {
            length_m += leg.norm();
            let Some(ahead) = leg.try_normalize(1e-6) else { continue };
            turn_rad += heading.map_or(0.0, |heading| angle_rad(heading, ahead));
            heading = Some(ahead);
        }
        if let (Some(heading), Some(left)) = (heading, left) {
            turn_rad += angle_rad(heading, left);
        }
        Self { length_m, turn_rad }
    }

    /// The extra cost compared with another course, metres, with turns at this price.
    pub(crate) fn excess_m(self, other: Self, turn_m_per_rad: f64) -> f64 {
        self.length_m - other.length_m + turn_m_per_rad * (self.turn_rad - other.turn_rad)
    }
}
