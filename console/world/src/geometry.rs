//! Points, vectors and poses of the tank frame.

use nalgebra::{Isometry2, Point2, Vector2};
use serde::{Deserialize, Serialize};

/// A place on the tank floor, metres, tank frame.
pub type Point = Point2<f64>;
/// A displacement, velocity or force on the tank floor.
pub type Vector = Vector2<f64>;

/// Where a robot stands and which way it looks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Position of the robot's centre, metres, tank frame.
    pub position: Point,
    /// Heading, radians, counter-clockwise from east.
    pub heading_rad: f64,
}

impl Pose {
    /// A pose from its three numbers.
    pub fn new(x_m: f64, y_m: f64, heading_rad: f64) -> Self {
        Self { position: Point::new(x_m, y_m), heading_rad }
    }

    /// Unit vector of the heading.
    pub fn direction(&self) -> Vector {
        Vector::new(self.heading_rad.cos(), self.heading_rad.sin())
    }

    /// The transform that takes points of the robot frame (x ahead, y left) to the tank frame.
    pub fn tank_from_robot(&self) -> Isometry2<f64> {
        Isometry2::new(self.position.coords, self.heading_rad)
    }
}

/// An angle brought into (-pi, pi].
pub fn wrap_angle_rad(angle_rad: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    let wrapped = angle_rad.rem_euclid(turn);
    if wrapped > std::f64::consts::PI { wrapped - turn } else { wrapped }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_wrapped_angle_points_the_same_way(angle in -1e3..1e3_f64) {
            let wrapped = wrap_angle_rad(angle);
            prop_assert!(wrapped > -std::f64::consts::PI - 1e-12 && wrapped <= std::f64::consts::PI + 1e-12);
            prop_assert!((wrapped.cos() - angle.cos()).abs() < 1e-9 && (wrapped.sin() - angle.sin()).abs() < 1e-9);
        }
    }
}
