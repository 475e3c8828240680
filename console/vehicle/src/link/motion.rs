//! The motion between readings, from odometry or from poses.

use crate::wire::message::{Odometry, Pose, Readings};
use std::f64::consts::{PI, TAU};

/// Turns readings, in the order of their numbers, into motions.
#[derive(Debug, Clone, Default)]
pub struct Motions {
    before: Option<(f64, Pose)>,
}

impl Motions {
    /// The motion that these readings report: since the last pose if they have one, otherwise since the readings before
    /// them. `None` if nothing is known.
    pub fn take(&mut self, readings: &Readings) -> Option<Odometry> {
        // The next pose contains the motion of readings without one.
        let Some(pose) = readings.pose else { return readings.odometry.filter(|_| self.before.is_none()) };
        let (before_s, before) = self.before.replace((readings.stamp_s, pose))?;
        let over_s = readings.stamp_s - before_s;
        (over_s > 0.0).then(|| between(&before, &pose, over_s))
    }
}

fn between(before: &Pose, pose: &Pose, over_s: f64) -> Odometry {
    let (x, y) = (pose.x_m - before.x_m, pose.y_m - before.y_m);
    let (sin, cos) = before.heading_rad.sin_cos();
    let turn_rad = (pose.heading_rad - before.heading_rad + PI).rem_euclid(TAU) - PI;
    Odometry { over_s, forward_m: x * cos + y * sin, sideways_m: y * cos - x * sin, turn_rad }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_goes_before_odometry_and_turns_the_short_way() {
        let at = |stamp_s: f64, x_m: f64, y_m: f64, heading_rad: f64| Readings {
            stamp_s,
            pose: Some(Pose { x_m, y_m, heading_rad }),
            odometry: Some(Odometry { over_s: 0.1, forward_m: 9.0, sideways_m: 0.0, turn_rad: 9.0 }),
            ..Readings::default()
        };
        let mut motions = Motions::default();
        assert_eq!(motions.take(&at(1.0, 5.0, 5.0, PI - 0.1)), None);
        let Odometry { over_s, forward_m, turn_rad, .. } =
            motions.take(&at(1.5, 4.9, 5.0, 0.1 - PI)).expect("two poses");
        assert!((over_s - 0.5).abs() < 1e-12 && (turn_rad - 0.2).abs() < 1e-12, "{turn_rad}");
        assert!((forward_m - 0.1 * 0.1_f64.cos()).abs() < 1e-12);
        let odometry = Odometry { over_s: 0.1, forward_m: 0.01, sideways_m: 0.0, turn_rad: 0.0 };
        let readings = Readings { odometry: Some(odometry), ..Readings::default() };
        assert_eq!(Motions::default().take(&readings), Some(odometry));
    }
}
