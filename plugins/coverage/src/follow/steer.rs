//! Steers a tracked robot along a path: on circular arcs that end on the path, slower at bends.
//!
//! This is pure pursuit: the robot drives on the one arc that begins along its heading and meets the aim. On a path of
//! constant curvature, the robot follows without an offset. A robot that merely turned towards its aim would have an
//! offset, and would cut inside the path around a column.

use planner_api::{Drive, Limits};
use std::collections::VecDeque;
use world::{
    Point, Vector,
    geometry::{Braking, wrap_angle_rad},
};

/// Angle to the aim beyond which the robot turns on the spot, radians.
const TURN_FIRST_RAD: f64 = 0.5;
/// Turn rate per angle to the aim when turning on the spot, 1/s.
const TURN_GAIN_PER_S: f64 = 2.5;
/// Distance to the aim below which the arc does not get any tighter, metres.
const LEAST_REACH_M: f64 = 0.15;
/// Share of the turn rate that an arc may use; the rest is for corrections.
const TURN_SHARE: f64 = 0.9;
/// A slowed robot turns at least as fast as if it drove along its arc at this speed, metres per second. While it heads
/// for a column, it stays slow until it has turned away; without this minimum, it would turn as slowly as it creeps.
const TURNING_M_PER_S: f64 = 0.15;
/// Angle above which a turn of a path is a corner, radians.
const CORNER_RAD: f64 = 0.5;
/// Length of path within which turns form one bend, metres: as far as the robot looks ahead.
const BEND_M: f64 = 0.25;
/// Distance from a corner within which the robot is at the corner, metres.
const AT_CORNER_M: f64 = 0.05;
/// Minimum time to reach a corner at the current speed, seconds; the robot slows down accordingly.
const CORNER_S: f64 = 0.6;
/// Minimum speed before corners, metres per second.
const LEAST_M_PER_S: f64 = 0.08;

/// The twist along the arc that begins along the heading and ends at the aim, at the speed of the desired velocity.
pub(super) fn twist(wanted: Vector, heading_rad: f64, reach_m: f64, limits: &Limits) -> Drive {
    let speed = wanted.norm();
    if speed < 1e-9 {
        return Drive::STILL;
    }
    let off_rad = wrap_angle_rad(wanted.y.atan2(wanted.x) - heading_rad);
    if off_rad.abs() > TURN_FIRST_RAD {
        let w_rad_per_s = (TURN_GAIN_PER_S * off_rad).clamp(-limits.w_max_rad_per_s, limits.w_max_rad_per_s);
        return Drive::Twist { v_m_per_s: 0.0, w_rad_per_s };
    }
    let curvature = 2.0 * off_rad.sin() / reach_m.max(LEAST_REACH_M);
    let fastest = TURN_SHARE * limits.w_max_rad_per_s / curvature.abs().max(1e-9);
    let v_m_per_s = speed.min(fastest);
    Drive::Twist { v_m_per_s, w_rad_per_s: v_m_per_s.max(TURNING_M_PER_S.min(fastest)) * curvature }
}

/// The highest speed from which the robot can still slow down in time for every corner and bend ahead, and for the end
/// of the path, metres per second.
pub(super) fn speed_ahead(at: Point, ahead: &[Point], limits: &Limits) -> f64 {
    let braking = Braking::of(limits);
    let mut along_m = 0.0;
    let mut from = at;
    let mut fastest = f64::INFINITY;
    let mut turns = Bends::default();
    for (k, point) in ahead.iter().enumerate() {
        let into = point - from;
        along_m += into.norm();
        if let Some(next) = ahead.get(k + 1) {
            let onward = next - point;
            let turn_rad = if into.norm() > AT_CORNER_M { into.angle(&onward) } else { 0.0 };
            if turn_rad > CORNER_RAD {
                let corner = (along_m / CORNER_S).max(LEAST_M_PER_S);
                return fastest.min(corner).min(braking.speed_before(along_m, LEAST_M_PER_S));
            }
            let bend = turns.sharpest_with(along_m, turn_rad);
            let there = TURN_SHARE * limits.w_max_rad_per_s / bend.max(1e-9);
            fastest = fastest.min(braking.speed_before(along_m, there.max(LEAST_M_PER_S)));
        }
        from = *point;
    }
    fastest.min(braking.speed_before(along_m, LEAST_M_PER_S))
}

/// The turning of a path within a short distance.
#[derive(Default)]
struct Bends {
    within: VecDeque<(f64, f64)>,
}

impl Bends {
    /// Adds a turn at a point of the path and returns the curvature there, radians per metre.
    fn sharpest_with(&mut self, along_m: f64, turn_rad: f64) -> f64 {
        self.within.push_back((along_m, turn_rad));
        while self.within.front().is_some_and(|(at_m, _)| along_m - at_m > BEND_M) {
            self.within.pop_front();
        }
        self.within.iter().map(|(_, turn_rad)| turn_rad).sum::<f64>() / BEND_M
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_api::Motion;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    const LIMITS: Limits = Limits {
        motion: Motion::Unicycle,
        v_max_m_per_s: 0.4,
        w_max_rad_per_s: 1.0,
        radius_m: 0.2,
        sensing_range_m: 2.0,
        acceleration_m_per_s2: 0.5,
        tick_s: 0.1,
        amphibious: None,
    };

    #[test]
    fn an_aim_behind_is_turned_to_on_the_spot_and_none_is_none() {
        let Drive::Twist { v_m_per_s, w_rad_per_s } = twist(Vector::new(-0.4, 0.1), 0.0, 0.3, &LIMITS) else {
            panic!("tracks take twists")
        };
        assert!(v_m_per_s.abs() < 1e-12 && (w_rad_per_s - 1.0).abs() < 1e-12);
        assert_eq!(twist(Vector::zeros(), 1.0, 0.3, &LIMITS), Drive::STILL);
    }

    #[test]
    fn a_corner_slows_down_and_a_bend_does_not() {
        let at = Point::origin();
        let straight: Vec<Point> = (1..9).map(|k| Point::new(0.1 * f64::from(k), 0.0)).collect();
        assert!(speed_ahead(at, &straight, &LIMITS) > 0.4);
        let mut corner = straight[..3].to_vec();
        corner.push(Point::new(0.3, 0.1));
        assert!((speed_ahead(at, &corner, &LIMITS) - 0.5).abs() < 1e-9);
        assert!((speed_ahead(Point::new(0.24, 0.0), &corner[2..], &LIMITS) - 0.1).abs() < 1e-9);
        let bend: Vec<Point> = (1..9)
            .map(|k| Point::new((0.2 * f64::from(k)).sin() * 0.5, 0.5 - (0.2 * f64::from(k)).cos() * 0.5))
            .collect();
        assert!(speed_ahead(at, &bend, &LIMITS) > 0.4);
    }

    #[test]
    fn a_robot_that_is_slowed_down_turns_no_slower_for_it() {
        let turn_of =
            |speed: f64| match twist(Vector::new(0.3_f64.cos(), 0.3_f64.sin()) * speed, 0.0, 0.3, &LIMITS) {
                Drive::Twist { w_rad_per_s, .. } => w_rad_per_s,
                Drive::Velocity(_) => panic!("tracks take twists"),
            };
        assert!(turn_of(0.006) > 0.25, "{}", turn_of(0.006));
        assert!(turn_of(0.4) > turn_of(0.006));
    }

    proptest! {
        #[test]
        fn the_arc_meets_the_aim(reach in 0.2..1.0_f64, off in -0.45..0.45_f64, heading in -PI..PI, speed in TURNING_M_PER_S..0.4_f64) {
            let direction = Vector::new((heading + off).cos(), (heading + off).sin());
            let Drive::Twist { v_m_per_s, w_rad_per_s } = twist(direction * speed, heading, reach, &LIMITS) else {
                panic!("tracks take twists")
            };
            prop_assert!(w_rad_per_s.abs() <= 1.0 && v_m_per_s <= speed + 1e-12);
            // The end of the arc, where the heading has turned by twice the angle to the aim.
            let (turn, ahead) = (2.0 * off, Vector::new(heading.cos(), heading.sin()));
            let left = Vector::new(-ahead.y, ahead.x);
            let radius = v_m_per_s / w_rad_per_s;
            let end = ahead * (radius * turn.sin()) + left * (radius * (1.0 - turn.cos()));
            prop_assert!(off.abs() < 1e-3 || (end - direction * reach).norm() < 1e-6, "{end} {}", direction * reach);
        }
    }
}
