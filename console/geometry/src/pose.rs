//! Points, vectors and poses in the tank frame.

use nalgebra::{Isometry2, Point2, Rotation2, Vector2};

/// A place on the tank floor, metres, tank frame.
pub type Point = Point2<f64>;
/// A displacement (metres), velocity (metres per second) or force in the tank frame.
pub type Vector = Vector2<f64>;

/// Position and heading of a robot.
///
/// ```
/// let pose = geometry::Pose::new(2.0, 1.0, std::f64::consts::FRAC_PI_2);
/// assert_eq!(pose.position.y, 1.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pose {
    /// Position of the robot's centre, metres, tank frame.
    pub position: Point,
    /// Heading, radians, counter-clockwise from east.
    pub heading_rad: f64,
}

impl Pose {
    /// Creates a pose from its coordinates, metres, and its heading, radians; all in the tank frame.
    ///
    /// ```
    /// use geometry::{Point, Pose};
    /// assert_eq!(Pose::new(2.0, 1.0, 0.5).position, Point::new(2.0, 1.0));
    /// ```
    pub fn new(x_m: f64, y_m: f64, heading_rad: f64) -> Self {
        Self { position: Point::new(x_m, y_m), heading_rad }
    }

    /// Unit vector of the heading, tank frame.
    ///
    /// ```
    /// use geometry::{Pose, Vector};
    /// let north = Pose::new(0.0, 0.0, std::f64::consts::FRAC_PI_2);
    /// assert!((north.direction() - Vector::y()).norm() < 1e-12);
    /// ```
    pub fn direction(&self) -> Vector {
        unit_vector(self.heading_rad)
    }

    /// The transform from the robot frame (x ahead, y left) to the tank frame.
    ///
    /// ```
    /// use geometry::{Point, Pose};
    /// let north = Pose::new(2.0, 1.0, std::f64::consts::FRAC_PI_2);
    /// let ahead = north.tank_from_robot() * Point::new(3.0, 0.0);
    /// assert!((ahead - Point::new(2.0, 4.0)).norm() < 1e-12);
    /// ```
    pub fn tank_from_robot(&self) -> Isometry2<f64> {
        Isometry2::new(self.position.coords, self.heading_rad)
    }

    /// The pose after an arc. `forward_m` and `sideways_m` are distances along the robot's own axes, metres; these axes
    /// turn at a constant rate by `turn_rad`, radians, in total.
    ///
    /// ```
    /// use geometry::{Point, Pose};
    /// use std::f64::consts::PI;
    /// // Half a circle of radius 1 m to the left.
    /// let end = Pose::new(0.0, 0.0, 0.0).moved(PI, 0.0, PI);
    /// assert!((end.position - Point::new(0.0, 2.0)).norm() < 1e-12);
    /// assert!((end.heading_rad - PI).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn moved(&self, forward_m: f64, sideways_m: f64, turn_rad: f64) -> Self {
        let half = turn_rad / 2.0;
        // Ratio of the chord to the length of the arc.
        let shortening = if half.abs() < 1e-6 { 1.0 } else { half.sin() / half };
        let chord = Rotation2::new(self.heading_rad + half) * Vector::new(forward_m, sideways_m) * shortening;
        Self { position: self.position + chord, heading_rad: wrap_angle_rad(self.heading_rad + turn_rad) }
    }
}

/// Unit vector with the given bearing, radians, counter-clockwise from east.
///
/// ```
/// use geometry::{Vector, unit_vector};
/// assert_eq!(unit_vector(0.0), Vector::x());
/// ```
pub fn unit_vector(bearing_rad: f64) -> Vector {
    Vector::new(bearing_rad.cos(), bearing_rad.sin())
}

/// The equivalent angle in (-pi, pi], radians.
///
/// ```
/// use std::f64::consts::PI;
/// assert!((geometry::wrap_angle_rad(1.5 * PI) + 0.5 * PI).abs() < 1e-12);
/// ```
pub fn wrap_angle_rad(angle_rad: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    let wrapped = angle_rad.rem_euclid(turn);
    if wrapped > std::f64::consts::PI { wrapped - turn } else { wrapped }
}

/// Unit vector along `vector`, or `fallback` if `vector` is shorter than 1e-9.
///
/// ```
/// use geometry::{Vector, direction_or};
/// assert_eq!(direction_or(Vector::new(0.0, 3.0), Vector::x()), Vector::y());
/// assert_eq!(direction_or(Vector::zeros(), Vector::x()), Vector::x());
/// ```
pub fn direction_or(vector: Vector, fallback: Vector) -> Vector {
    let length = vector.norm();
    if length > 1e-9 { vector / length } else { fallback }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_quarter_turn_on_the_way_ends_ahead_and_to_the_left() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let pose = Pose::new(1.0, 0.0, quarter).moved(quarter * 2.0, 0.0, quarter);
        assert!((pose.position - Point::new(-1.0, 2.0)).norm() < 1e-12);
        assert!((pose.heading_rad - 2.0 * quarter).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn two_halves_of_an_arc_make_the_whole(way in -5.0..5.0_f64, aside in -1.0..1.0_f64, turn in -3.0..3.0_f64) {
            let start = Pose::new(1.0, -2.0, 0.3);
            let whole = start.moved(way, aside, turn);
            let halves = start.moved(way / 2.0, aside / 2.0, turn / 2.0).moved(way / 2.0, aside / 2.0, turn / 2.0);
            prop_assert!((whole.position - halves.position).norm() < 1e-9);
            prop_assert!(wrap_angle_rad(whole.heading_rad - halves.heading_rad).abs() < 1e-9);
        }

        #[test]
        fn a_wrapped_angle_points_the_same_way(angle in -1e3..1e3_f64) {
            let wrapped = wrap_angle_rad(angle);
            prop_assert!(wrapped > -std::f64::consts::PI - 1e-12 && wrapped <= std::f64::consts::PI + 1e-12);
            prop_assert!((wrapped.cos() - angle.cos()).abs() < 1e-9 && (wrapped.sin() - angle.sin()).abs() < 1e-9);
        }
    }
}
