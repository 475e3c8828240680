//! Converts a drive command into the arc that the tracks drive in one tick.

use crate::config::RobotConfig;
use geometry::{Drive, Pose, Vector, unit_vector, wrap_angle_rad};
use world::Pace;

/// Maximum motion in one tick, metres or radians; keeps the results finite even with absurd settings.
const LONGEST: f64 = 1e6;

/// The motion of the tracks in one tick, in the robot frame: forward along the heading, while the heading turns at a
/// constant rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Arc {
    /// Change of heading before the motion starts, radians; a point robot turns instantly.
    pub turn_first_rad: f64,
    /// Distance ahead, metres; negative backward.
    pub way_m: f64,
    /// Change of heading along the arc, radians.
    pub turn_rad: f64,
}

/// The robot's speed and limits.
#[derive(Debug, Clone)]
pub(crate) struct Tracks {
    v_max_m_per_s: f64,
    w_max_rad_per_s: f64,
    acceleration_m_per_s2: f64,
    tick_s: f64,
    /// Velocity of the tracks without slip, tank frame.
    velocity: Vector,
}

impl Tracks {
    /// Tracks at rest. Negative limits count as zero.
    pub(crate) fn new(robot: &RobotConfig, tick_s: f64) -> Self {
        Self {
            v_max_m_per_s: robot.v_max_m_per_s.max(0.0),
            w_max_rad_per_s: robot.w_max_rad_per_s.max(0.0),
            acceleration_m_per_s2: robot.acceleration_m_per_s2.max(0.0),
            tick_s: tick_s.max(0.0),
            velocity: Vector::zeros(),
        }
    }

    /// Sets new limits. A robot that is faster than these limits brakes as hard as it can.
    pub(crate) fn set_limits(&mut self, pace: Pace) {
        self.v_max_m_per_s = pace.v_max_m_per_s.max(0.0);
        self.w_max_rad_per_s = pace.w_max_rad_per_s.max(0.0);
    }

    /// Follows a drive for one tick as closely as the limits allow. Numbers that are not finite count as zero.
    pub(crate) fn drive(&mut self, drive: Drive, pose: &Pose) -> Arc {
        match drive {
            Drive::Twist { v_m_per_s, w_rad_per_s } => {
                self.twist(finite(v_m_per_s), finite(w_rad_per_s), pose)
            }
            Drive::Velocity(velocity) => self.translate(velocity.map(finite), pose),
        }
    }

    fn twist(&mut self, v_m_per_s: f64, w_rad_per_s: f64, pose: &Pose) -> Arc {
        let wanted = v_m_per_s.clamp(-self.v_max_m_per_s, self.v_max_m_per_s);
        let now = self.velocity.dot(&pose.direction());
        let change = self.change_m_per_s();
        let speed = now + (wanted - now).clamp(-change, change);
        let turn = w_rad_per_s.clamp(-self.w_max_rad_per_s, self.w_max_rad_per_s) * self.tick_s;
        let arc = Arc { turn_first_rad: 0.0, way_m: bounded(speed * self.tick_s), turn_rad: bounded(turn) };
        let heading = pose.heading_rad + arc.turn_rad;
        self.velocity = unit_vector(heading) * speed;
        arc
    }

    fn translate(&mut self, wanted: Vector, pose: &Pose) -> Arc {
        let change = (shortened(wanted, self.v_max_m_per_s) - self.velocity).map(bounded);
        self.velocity += shortened(change, self.change_m_per_s());
        let speed = self.velocity.norm();
        let bearing = if speed > 0.0 { self.velocity.y.atan2(self.velocity.x) } else { pose.heading_rad };
        Arc {
            turn_first_rad: wrap_angle_rad(bearing - pose.heading_rad),
            way_m: bounded(speed * self.tick_s),
            turn_rad: 0.0,
        }
    }

    /// Stops the robot because it has hit something.
    pub(crate) fn stop(&mut self) {
        self.velocity = Vector::zeros();
    }

    fn change_m_per_s(&self) -> f64 {
        bounded(self.acceleration_m_per_s2 * self.tick_s)
    }
}

impl Arc {
    /// The pose after a share of the arc, 0 to 1.
    pub(crate) fn pose_after(&self, start: &Pose, share: f64) -> Pose {
        let turned = Pose { heading_rad: start.heading_rad + self.turn_first_rad, ..*start };
        turned.moved(self.way_m * share, 0.0, self.turn_rad * share)
    }

    /// The same motion as a single arc that starts with the previous heading: distance forward and to the left, metres,
    /// and change of heading, radians.
    pub(crate) fn seen_from_start(&self) -> (f64, f64, f64) {
        if self.turn_first_rad == 0.0 {
            return (self.way_m, 0.0, self.turn_rad);
        }
        // A chord as long as the distance, in the direction halfway through the turn from the previous heading; the arc
        // itself is longer than its chord.
        let half = self.turn_first_rad / 2.0;
        let length = self.way_m * if half.abs() < 1e-6 { 1.0 } else { half / half.sin() };
        (length * half.cos(), length * half.sin(), self.turn_first_rad)
    }
}

fn shortened(vector: Vector, longest: f64) -> Vector {
    let length = vector.norm();
    if length > longest { vector * (longest / length) } else { vector }
}

fn finite(number: f64) -> f64 {
    if number.is_finite() { number.clamp(-LONGEST, LONGEST) } else { 0.0 }
}

/// The number, limited to the maximum motion in one tick.
pub(crate) fn bounded(number: f64) -> f64 {
    number.clamp(-LONGEST, LONGEST)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn tracks() -> Tracks {
        Tracks {
            v_max_m_per_s: 0.5,
            w_max_rad_per_s: 1.0,
            acceleration_m_per_s2: 0.8,
            tick_s: 0.1,
            velocity: Vector::zeros(),
        }
    }

    fn any_drive() -> impl Strategy<Value = Drive> {
        let number = || prop_oneof![4 => -2.0..2.0_f64, 1 => prop::num::f64::ANY];
        prop_oneof![
            (number(), number()).prop_map(|(v_m_per_s, w_rad_per_s)| Drive::Twist { v_m_per_s, w_rad_per_s }),
            (number(), number()).prop_map(|(x, y)| Drive::Velocity(Vector::new(x, y))),
        ]
    }

    proptest! {
        #[test]
        fn limits_are_never_exceeded(drives in prop::collection::vec(any_drive(), 1..60)) {
            let (mut tracks, mut pose) = (tracks(), Pose::new(0.0, 0.0, 0.3));
            for drive in drives {
                let speed_before = tracks.velocity.norm();
                let arc = tracks.drive(drive, &pose);
                prop_assert!(arc.way_m.abs() <= 0.05 + 1e-12);
                prop_assert!(arc.turn_rad.abs() <= 0.1 + 1e-12);
                prop_assert!(matches!(drive, Drive::Velocity(_)) || arc.turn_first_rad == 0.0);
                // Tracks cannot keep a velocity across their axis: switching from a velocity loses that part at once.
                let change = tracks.velocity.norm() - speed_before;
                prop_assert!(change <= 0.08 + 1e-9, "{change}");
                pose = arc.pose_after(&pose, 1.0);
                prop_assert!(pose.position.iter().all(|c| c.is_finite()) && pose.heading_rad.is_finite());
            }
        }

        #[test]
        fn a_motion_seen_from_the_start_ends_at_the_same_pose(
            first in -3.1..3.1_f64, way in -1.0..1.0_f64, turn in -1.0..1.0_f64,
        ) {
            let start = Pose::new(2.0, 1.0, 0.8);
            let turn_rad = if first.abs() < 1.0 { turn } else { 0.0 };
            let turn_first_rad = if turn_rad == 0.0 { first } else { 0.0 };
            let arc = Arc { turn_first_rad, way_m: way, turn_rad };
            let (forward, sideways, turned) = arc.seen_from_start();
            let (a, b) = (arc.pose_after(&start, 1.0), start.moved(forward, sideways, turned));
            prop_assert!((a.position - b.position).norm() < 1e-9);
            prop_assert!(wrap_angle_rad(a.heading_rad - b.heading_rad).abs() < 1e-9);
        }
    }

    #[test]
    fn the_speed_builds_up_at_the_acceleration() {
        let mut tracks = tracks();
        let ways: Vec<f64> = (0..8)
            .map(|_| {
                tracks
                    .drive(Drive::Twist { v_m_per_s: 9.0, w_rad_per_s: 0.0 }, &Pose::new(0.0, 0.0, 0.0))
                    .way_m
            })
            .collect();
        assert!((ways[0] - 0.008).abs() < 1e-12 && (ways[1] - 0.016).abs() < 1e-12);
        assert!((ways[7] - 0.05).abs() < 1e-12);
    }

    #[test]
    fn a_point_robot_faces_where_it_goes() {
        let mut tracks = tracks();
        let arc = tracks.drive(Drive::Velocity(Vector::new(0.0, 0.05)), &Pose::new(0.0, 0.0, 0.0));
        let pose = arc.pose_after(&Pose::new(0.0, 0.0, 0.0), 1.0);
        assert!((pose.heading_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        assert!((pose.position.y - 0.005).abs() < 1e-12 && pose.position.x.abs() < 1e-12);
    }
}
