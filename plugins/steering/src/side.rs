//! The side on which an obstacle is passed.

use geometry::Vector;

/// The side on which to pass, seen when looking at the obstacle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The obstacle stays on the right: clockwise around it, seen from above.
    Left,
    /// The obstacle stays on the left: counter-clockwise around it.
    Right,
}

impl Side {
    /// The other side.
    #[must_use]
    pub fn other(self) -> Self {
        if self == Self::Left { Self::Right } else { Self::Left }
    }

    /// 1 for left, -1 for right.
    pub fn sign(self) -> f64 {
        if self == Self::Left { 1.0 } else { -1.0 }
    }

    /// Unit tangent at a solid whose outward direction at the robot is `away`: towards this side of the solid, as seen
    /// by a robot facing it.
    pub fn along(self, away: Vector) -> Vector {
        Vector::new(away.y, -away.x) * self.sign()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_left_of_something_ahead_is_north_when_looking_east() {
        assert!((Side::Left.along(-Vector::x()) - Vector::y()).norm() < 1e-12);
    }

    #[test]
    fn both_sides_are_opposite_tangents() {
        let away = Vector::new(0.6, 0.8);
        let (left, right) = (Side::Left.along(away), Side::Right.along(away));
        assert!(left.dot(&away).abs() < 1e-12 && (left + right).norm() < 1e-12);
        // East of an obstacle, counter-clockwise is north.
        assert!(Side::Right.along(Vector::x()).y > 0.0);
    }
}
