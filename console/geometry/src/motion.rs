//! The robot's way of moving, its limits, and the control law that turns a planner's command into a drive within them.

use crate::{Amphibious, Point, Pose, Vector, unit_vector, wrap_angle_rad};

/// Heading error above which a unicycle turns on the spot before it drives, radians.
pub const TURN_FIRST_RAD: f64 = 1.0;
/// Heading error above which a unicycle turns on the spot while it follows lanes exactly, radians: a wide curve at the
/// end of a lane would take the robot into the wall.
pub const TURN_FIRST_IN_LANES_RAD: f64 = 0.25;
/// Turn rate per unit of heading error, 1/s: an error of 0.5 rad decays in about a second.
const HEADING_GAIN_PER_S: f64 = 2.5;

/// Interval between the poses of a rollout, seconds.
const ROLLOUT_STEP_S: f64 = 0.1;

/// Relative tolerance for a speed above the limit, to allow for rounding.
const ROUNDING: f64 = 1e-12;

/// The robot's way of moving.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[repr(u32)]
pub enum Motion {
    /// In any direction without turning, like the point robots in the papers.
    Point = 0,
    /// Forward and backward along its heading, and turning, like tracked and wheeled robots.
    Unicycle = 1,
}

/// The robot's limits.
///
/// ```
/// use geometry::{Limits, Motion};
/// let limits = Limits {
///     motion: Motion::Unicycle,
///     v_max_m_per_s: 0.4,
///     w_max_rad_per_s: 1.0,
///     radius_m: 0.25,
///     sensing_range_m: 2.0,
///     acceleration_m_per_s2: 0.5,
///     tick_s: 0.1,
///     amphibious: None,
/// };
/// assert_eq!(limits.motion as u32, 1);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Limits {
    /// The robot's way of moving.
    pub motion: Motion,
    /// Maximum speed, metres per second.
    pub v_max_m_per_s: f64,
    /// Maximum turn rate, radians per second.
    pub w_max_rad_per_s: f64,
    /// Radius of the hull, a disc about the robot's centre, metres.
    pub radius_m: f64,
    /// Range within which the robot sees obstacles, metres.
    pub sensing_range_m: f64,
    /// Maximum acceleration, metres per second squared.
    pub acceleration_m_per_s2: f64,
    /// Length of a tick, seconds: the time for which a command is in effect before the next one can replace it.
    pub tick_s: f64,
    /// For a robot that walks and swims, the limits in each mode. The fields above hold the larger limit of the two
    /// modes.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub amphibious: Option<Amphibious>,
}

/// The robot's motion until the next tick.
///
/// ```
/// use geometry::Drive;
/// assert_eq!(Drive::STILL, Drive::Twist { v_m_per_s: 0.0, w_rad_per_s: 0.0 });
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Drive {
    /// Speed and turn rate, for planners that command tracks or wheels.
    Twist {
        /// Speed along the robot's heading, metres per second; negative is backward.
        v_m_per_s: f64,
        /// Turn rate, radians per second, counter-clockwise.
        w_rad_per_s: f64,
    },
    /// Velocity in the tank frame, metres per second. For planners that compute directions: [`drive_for`] controls the
    /// heading for them.
    Velocity(Vector),
}

impl Drive {
    /// A robot that stands still.
    pub const STILL: Self = Self::Twist { v_m_per_s: 0.0, w_rad_per_s: 0.0 };
}

/// Converts a planner's command into the drive that is sent to the robot: within the robot's limits, and in a form that
/// suits its way of moving.
///
/// A unicycle receives a turn rate proportional to the error between `heading_rad` and the direction of the velocity. The
/// speed is multiplied by the cosine of that error; above `turn_first_rad` the unicycle turns on the spot. For a point
/// robot, a twist becomes a velocity along its heading. A drive that has been converted already is returned unchanged.
///
/// ```
/// use geometry::{Drive, Limits, Motion, Vector, motion::{TURN_FIRST_RAD, drive_for}};
/// # let (motion, radius_m, sensing_range_m) = (Motion::Unicycle, 0.25, 2.0);
/// # let (acceleration_m_per_s2, tick_s, amphibious) = (0.5, 0.1, None);
/// let limits = Limits {
///     motion, v_max_m_per_s: 0.4, w_max_rad_per_s: 1.0, radius_m, sensing_range_m, acceleration_m_per_s2, tick_s,
///     amphibious,
/// };
/// let east = Drive::Velocity(Vector::new(0.3, 0.0));
/// let sent = drive_for(east, 0.2, &limits, TURN_FIRST_RAD);
/// let Drive::Twist { w_rad_per_s, .. } = sent else { unreachable!("a unicycle takes twists") };
/// assert!((w_rad_per_s + 0.5).abs() < 1e-12);
/// ```
pub fn drive_for(command: Drive, heading_rad: f64, limits: &Limits, turn_first_rad: f64) -> Drive {
    match (limits.motion, command) {
        (Motion::Point, Drive::Velocity(velocity)) => {
            Drive::Velocity(at_most(velocity, limits.v_max_m_per_s))
        }
        (Motion::Point, Drive::Twist { v_m_per_s, .. }) => {
            let velocity = unit_vector(heading_rad) * v_m_per_s;
            Drive::Velocity(at_most(velocity, limits.v_max_m_per_s))
        }
        (Motion::Unicycle, Drive::Twist { v_m_per_s, w_rad_per_s }) => twist(v_m_per_s, w_rad_per_s, limits),
        (Motion::Unicycle, Drive::Velocity(velocity)) => {
            turn_into(velocity, heading_rad, limits, turn_first_rad)
        }
    }
}

/// The poses of a robot that follows one constant command from a start pose for a given time, seconds; one pose for every
/// tenth of a second.
///
/// ```
/// use geometry::{Drive, Limits, Motion, Pose, Vector, motion::{TURN_FIRST_RAD, rollout}};
/// # let (motion, radius_m, sensing_range_m) = (Motion::Unicycle, 0.25, 2.0);
/// # let (acceleration_m_per_s2, tick_s, amphibious) = (0.5, 0.1, None);
/// let limits = Limits {
///     motion, v_max_m_per_s: 0.4, w_max_rad_per_s: 1.0, radius_m, sensing_range_m, acceleration_m_per_s2, tick_s,
///     amphibious,
/// };
/// let north = Drive::Velocity(Vector::new(0.0, 0.3));
/// let way = rollout(north, Pose::new(0.0, 0.0, 0.0), &limits, TURN_FIRST_RAD, 5.0);
/// let end = way.last().unwrap();
/// assert!((end.heading_rad - std::f64::consts::FRAC_PI_2).abs() < 0.01 && end.position.y > 0.9);
/// ```
pub fn rollout(
    command: Drive,
    from: Pose,
    limits: &Limits,
    turn_first_rad: f64,
    duration_s: f64,
) -> Vec<Pose> {
    let step = |pose: &Pose| {
        let heading_rad = pose.heading_rad;
        let (velocity, turn_rad) = match drive_for(command, heading_rad, limits, turn_first_rad) {
            Drive::Twist { v_m_per_s, w_rad_per_s } => {
                (unit_vector(heading_rad) * v_m_per_s, w_rad_per_s * ROLLOUT_STEP_S)
            }
            Drive::Velocity(velocity) => (velocity, 0.0),
        };
        let position: Point = pose.position + velocity * ROLLOUT_STEP_S;
        Some(Pose { position, heading_rad: wrap_angle_rad(heading_rad + turn_rad) })
    };
    let n_steps = (duration_s / ROLLOUT_STEP_S).round() as usize;
    std::iter::successors(Some(from), step).take(n_steps + 1).collect()
}

/// The angle from a heading to the direction of a velocity, radians in (-pi, pi].
///
/// ```
/// use geometry::{Vector, motion::heading_error_rad};
/// assert_eq!(heading_error_rad(Vector::new(1.0, 1.0), 0.0), std::f64::consts::FRAC_PI_4);
/// ```
pub fn heading_error_rad(velocity: Vector, heading_rad: f64) -> f64 {
    wrap_angle_rad(velocity.y.atan2(velocity.x) - heading_rad)
}

fn turn_into(velocity: Vector, heading_rad: f64, limits: &Limits, turn_first_rad: f64) -> Drive {
    let speed = velocity.norm();
    if speed == 0.0 {
        return Drive::STILL;
    }
    let error_rad = heading_error_rad(velocity, heading_rad);
    let ahead = if error_rad.abs() > turn_first_rad { 0.0 } else { speed * error_rad.cos() };
    twist(ahead, HEADING_GAIN_PER_S * error_rad, limits)
}

fn twist(v_m_per_s: f64, w_rad_per_s: f64, limits: &Limits) -> Drive {
    Drive::Twist {
        v_m_per_s: v_m_per_s.clamp(-limits.v_max_m_per_s, limits.v_max_m_per_s),
        w_rad_per_s: w_rad_per_s.clamp(-limits.w_max_rad_per_s, limits.w_max_rad_per_s),
    }
}

/// The velocity, shortened to a maximum speed if it exceeds that speed by more than rounding. A velocity that has already
/// been shortened is returned bit for bit.
///
/// ```
/// use geometry::{Vector, motion::at_most};
/// assert_eq!(at_most(Vector::new(3.0, 4.0), 2.5), Vector::new(1.5, 2.0));
/// ```
pub fn at_most(velocity: Vector, speed_m_per_s: f64) -> Vector {
    let speed = velocity.norm();
    if speed > speed_m_per_s * (1.0 + ROUNDING) { velocity * (speed_m_per_s / speed) } else { velocity }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn limits(motion: Motion) -> Limits {
        Limits {
            motion,
            v_max_m_per_s: 0.4,
            w_max_rad_per_s: 1.0,
            radius_m: 0.25,
            sensing_range_m: 2.0,
            acceleration_m_per_s2: 0.5,
            tick_s: 0.1,
            amphibious: None,
        }
    }

    #[test]
    fn a_unicycle_that_faces_the_wrong_way_turns_on_the_spot() {
        let drive = drive_for(
            Drive::Velocity(Vector::new(-0.4, 0.01)),
            0.0,
            &limits(Motion::Unicycle),
            TURN_FIRST_RAD,
        );
        let Drive::Twist { v_m_per_s, w_rad_per_s } = drive else { panic!("a unicycle takes twists") };
        assert!(v_m_per_s.abs() < f64::EPSILON && (w_rad_per_s - 1.0).abs() < f64::EPSILON);
    }

    proptest! {
        #[test]
        fn what_was_sent_is_sent_again_to_the_bit(x in -9.0..9.0_f64, y in -9.0..9.0_f64, heading in -4.0..4.0_f64) {
            for motion in [Motion::Point, Motion::Unicycle] {
                for command in [Drive::Velocity(Vector::new(x, y)), Drive::Twist { v_m_per_s: x, w_rad_per_s: y }] {
                    let sent = drive_for(command, heading, &limits(motion), TURN_FIRST_RAD);
                    prop_assert_eq!(drive_for(sent, heading, &limits(motion), TURN_FIRST_RAD), sent);
                }
            }
        }

        #[test]
        fn a_turn_by_the_heading_error_points_along_the_velocity(
            x in -9.0..9.0_f64, y in -9.0..9.0_f64, heading in -4.0..4.0_f64,
        ) {
            let velocity = Vector::new(x, y);
            let ahead = unit_vector(heading + heading_error_rad(velocity, heading));
            prop_assert!((ahead * velocity.norm() - velocity).norm() < 1e-9);
        }

        #[test]
        fn a_point_robot_keeps_the_direction_of_a_velocity(x in -9.0..9.0_f64, y in -9.0..9.0_f64) {
            let velocity = Vector::new(x, y);
            let sent = drive_for(Drive::Velocity(velocity), 0.7, &limits(Motion::Point), TURN_FIRST_RAD);
            let Drive::Velocity(sent) = sent else { panic!("a point robot takes velocities") };
            prop_assert!(sent.perp(&velocity).abs() < 1e-9 && sent.dot(&velocity) >= 0.0);
        }

        #[test]
        fn no_command_exceeds_the_limits(x in -9.0..9.0_f64, y in -9.0..9.0_f64, heading in -4.0..4.0_f64) {
            for motion in [Motion::Point, Motion::Unicycle] {
                for command in [Drive::Velocity(Vector::new(x, y)), Drive::Twist { v_m_per_s: x, w_rad_per_s: y }] {
                    match drive_for(command, heading, &limits(motion), TURN_FIRST_RAD) {
                        Drive::Velocity(v) => prop_assert!(v.norm() <= 0.4 + 1e-12),
                        Drive::Twist { v_m_per_s, w_rad_per_s } => {
                            prop_assert!(v_m_per_s.abs() <= 0.4 && w_rad_per_s.abs() <= 1.0);
                        }
                    }
                }
            }
        }
    }
}
