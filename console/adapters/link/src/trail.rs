//! The poses of the last seconds, by the stamps of their sender.

use crate::{
    clock::is_set_back,
    message::{Pose, Scan},
};
use std::{collections::VecDeque, f64::consts::PI};

/// Time for which poses are kept, seconds.
const KEPT_S: f64 = 2.0;

/// The poses of the last seconds, in the order of their stamps; messages may have overtaken each other.
#[derive(Debug, Clone, Default)]
pub struct Trail {
    /// Stamp, seconds of the sender's clock, and pose.
    poses: VecDeque<(f64, Pose)>,
}

impl Trail {
    /// Adds a pose that was measured at `stamp_s`, unless a pose with this stamp is there already. A stamp more than
    /// 1 s before the newest one starts a new trail.
    pub fn add(&mut self, pose: Pose, stamp_s: f64) {
        if self.newest_s().is_some_and(|newest_s| is_set_back(stamp_s, newest_s)) {
            self.poses.clear();
        }
        let after = self.poses.partition_point(|(at_s, _)| *at_s <= stamp_s);
        if after > 0 && self.poses[after - 1].0 == stamp_s {
            return;
        }
        self.poses.insert(after, (stamp_s, pose));
        while self.poses.front().is_some_and(|(oldest_s, _)| *oldest_s < stamp_s - KEPT_S) {
            self.poses.pop_front();
        }
    }

    /// The newest stamp, seconds of the sender's clock.
    pub fn newest_s(&self) -> Option<f64> {
        self.poses.back().map(|(stamp_s, _)| *stamp_s)
    }

    /// The pose at a time between two poses; `None` before the oldest and after the newest.
    pub fn at(&self, stamp_s: f64) -> Option<Pose> {
        let after = self.poses.partition_point(|(at_s, _)| *at_s < stamp_s);
        let (after_s, next) = self.poses.get(after)?;
        if *after_s == stamp_s {
            return Some(*next);
        }
        let (before_s, last) = self.poses.get(after.checked_sub(1)?)?;
        let share = (stamp_s - before_s) / (after_s - before_s);
        Some(Pose {
            x_m: last.x_m + share * (next.x_m - last.x_m),
            y_m: last.y_m + share * (next.y_m - last.y_m),
            heading_rad: last.heading_rad + share * turn_rad(last, next),
        })
    }
}

/// The turn from one pose to another, radians, at most half a turn.
fn turn_rad(from: &Pose, to: &Pose) -> f64 {
    (to.heading_rad - from.heading_rad + PI).rem_euclid(2.0 * PI) - PI
}

/// A scan that was taken at the pose `then`, as seen from the pose `now`: the place of the sensor and the direction of
/// the first ray change, the distances do not.
pub(crate) fn seen_from(scan: Scan, then: &Pose, now: &Pose) -> Scan {
    let turned = turn_rad(now, then);
    let rotated = |[x_m, y_m]: [f64; 2], rad: f64| {
        let (sin, cos) = rad.sin_cos();
        [cos * x_m - sin * y_m, sin * x_m + cos * y_m]
    };
    let from_now = rotated([then.x_m - now.x_m, then.y_m - now.y_m], -now.heading_rad);
    let mounted = rotated(scan.sensor_m, turned);
    Scan {
        sensor_m: [from_now[0] + mounted[0], from_now[1] + mounted[1]],
        first_rad: scan.first_rad + turned,
        ..scan
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    fn pose(x_m: f64, heading_rad: f64) -> Pose {
        Pose { x_m, y_m: 0.0, heading_rad }
    }

    #[test]
    fn a_pose_between_two_is_interpolated_whatever_their_order() {
        let mut trail = Trail::default();
        trail.add(pose(2.0, -3.0), 10.2);
        trail.add(pose(1.0, 3.0), 10.0);
        trail.add(pose(9.0, 0.0), 10.0);
        let middle = trail.at(10.1).unwrap();
        assert!((middle.x_m - 1.5).abs() < 1e-9);
        assert!((middle.heading_rad - PI).abs() < 1e-6, "the short way round: {}", middle.heading_rad);
        assert_eq!((trail.at(10.0), trail.at(9.9), trail.at(10.3)), (Some(pose(1.0, 3.0)), None, None));
    }

    #[test]
    fn old_poses_are_forgotten_and_a_clock_that_was_set_back_starts_again() {
        let mut trail = Trail::default();
        for n in 0..1000 {
            trail.add(pose(0.0, 0.0), f64::from(n) * 0.01);
        }
        assert!(trail.poses.len() <= 201 && trail.at(7.9).is_none());
        trail.add(pose(1.0, 0.0), 3.0);
        assert_eq!((trail.poses.len(), trail.newest_s()), (1, Some(3.0)));
    }

    #[test]
    fn a_scan_seen_from_another_pose_shows_the_same_points() {
        let scan = Scan {
            first_rad: 0.3,
            step_rad: 0.1,
            range_max_m: 8.0,
            sensor_m: [0.2, 0.1],
            ranges_m: vec![Some(1.0), None, Some(2.0)],
        };
        let then = Pose { x_m: 1.0, y_m: -2.0, heading_rad: 0.4 };
        let now = Pose { x_m: 1.3, y_m: -1.9, heading_rad: 0.4 + FRAC_PI_2 };
        let point = |scan: &Scan, at: &Pose, ray: u8| {
            let rad = scan.first_rad + f64::from(ray) * scan.step_rad;
            let range_m = scan.ranges_m[usize::from(ray)].unwrap();
            let (x_m, y_m) = (scan.sensor_m[0] + range_m * rad.cos(), scan.sensor_m[1] + range_m * rad.sin());
            let (sin, cos) = at.heading_rad.sin_cos();
            [at.x_m + cos * x_m - sin * y_m, at.y_m + sin * x_m + cos * y_m]
        };
        let moved = seen_from(scan.clone(), &then, &now);
        for ray in [0, 2] {
            let (before, after) = (point(&scan, &then, ray), point(&moved, &now, ray));
            assert!((before[0] - after[0]).abs() < 1e-12 && (before[1] - after[1]).abs() < 1e-12);
        }
    }
}
