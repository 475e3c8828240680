//! How a robot moves, what it can do, and the one law from a planner's command to what its drives can do.

use crate::{Vector, wrap_angle_rad};

/// Heading error beyond which a unicycle turns on the spot, radians.
pub const TURN_FIRST_RAD: f64 = 1.0;
/// The same along lanes that are to be followed exactly: a wide curve at the end of a lane leads into the wall.
pub const TURN_FIRST_IN_LANES_RAD: f64 = 0.25;
/// Turn rate per heading error, 1/s: a 0.5 rad error is gone in about a second.
const HEADING_GAIN_PER_S: f64 = 2.5;

/// Share by which a speed may exceed the limit by rounding.
const ROUNDING: f64 = 1e-12;

/// How the robot moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[repr(u32)]
pub enum Motion {
    /// In any direction at once, as the papers' point robots.
    Point = 0,
    /// Ahead and turning, as tracked and wheeled robots.
    Unicycle = 1,
}

/// What the robot can do.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Limits {
    /// How it moves.
    pub motion: Motion,
    /// Largest speed, metres per second.
    pub v_max_m_per_s: f64,
    /// Largest turn rate, radians per second.
    pub w_max_rad_per_s: f64,
    /// Radius of the smallest circle around the robot, metres.
    pub radius_m: f64,
    /// How far it sees obstacles, metres.
    pub sensing_range_m: f64,
}

/// How a robot is to move until the next tick.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Drive {
    /// Speed ahead and turn rate, for planners that think in tracks and wheels.
    Twist {
        /// Speed along the robot's heading, metres per second; negative is backward.
        v_m_per_s: f64,
        /// Turn rate, radians per second, counter-clockwise.
        w_rad_per_s: f64,
    },
    /// Velocity in the tank frame, metres per second; the console turns the robot into it. For planners that think
    /// in forces and directions, so that each need not bring its own heading control.
    Velocity(Vector),
}

impl Drive {
    /// Standing still.
    pub const STILL: Self = Self::Twist { v_m_per_s: 0.0, w_rad_per_s: 0.0 };
}

/// What the robot is sent for a planner's command: within its limits and in its own way of moving.
///
/// A unicycle turns into a velocity, on the spot above `turn_first_rad`, and slows down as the cosine of the heading
/// error; a point robot takes a twist as a velocity along its heading.
pub fn drive_for(command: Drive, heading_rad: f64, limits: &Limits, turn_first_rad: f64) -> Drive {
    match (limits.motion, command) {
        (Motion::Point, Drive::Velocity(velocity)) => {
            Drive::Velocity(at_most(velocity, limits.v_max_m_per_s))
        }
        (Motion::Point, Drive::Twist { v_m_per_s, .. }) => {
            let velocity = Vector::new(heading_rad.cos(), heading_rad.sin()) * v_m_per_s;
            Drive::Velocity(at_most(velocity, limits.v_max_m_per_s))
        }
        (Motion::Unicycle, Drive::Twist { v_m_per_s, w_rad_per_s }) => twist(v_m_per_s, w_rad_per_s, limits),
        (Motion::Unicycle, Drive::Velocity(velocity)) => {
            turn_into(velocity, heading_rad, limits, turn_first_rad)
        }
    }
}

/// The angle from a heading to the direction of a velocity, radians in (-pi, pi].
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

/// Shortens a velocity to a speed. What was shortened once may be longer than that by rounding and stays as it is, so that
/// a command that was sent can be fed in again.
fn at_most(velocity: Vector, speed_m_per_s: f64) -> Vector {
    let speed = velocity.norm();
    if speed > speed_m_per_s * (1.0 + ROUNDING) { velocity * (speed_m_per_s / speed) } else { velocity }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn limits(motion: Motion) -> Limits {
        Limits { motion, v_max_m_per_s: 0.4, w_max_rad_per_s: 1.0, radius_m: 0.25, sensing_range_m: 2.0 }
    }

    #[test]
    fn a_unicycle_that_looks_the_wrong_way_turns_on_the_spot() {
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
