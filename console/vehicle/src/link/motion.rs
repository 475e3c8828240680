//! The motion between readings, from odometry or from poses.

use crate::wire::message::{Odometry, Pose, Readings};
use std::f64::consts::{PI, TAU};

/// Largest time between the last motion and the start of the next one, as a share of the duration of the next one; if
/// more time has passed, a motion is missing in between.
const GAP_OF_MOTION: f64 = 0.5;

/// Turns readings, in the order of their numbers, into motions.
#[derive(Debug, Clone, Default)]
pub struct Motions {
    before: Option<(f64, Pose)>,
    /// The stamp of the last odometry, seconds.
    measured_s: Option<f64>,
}

impl Motions {
    /// The time before the motion of these readings for which the motion is unknown, seconds: the readings that contained
    /// it are lost, and no pose makes up for them. Call this before [`Self::take`].
    pub fn gap_s(&self, readings: &Readings) -> f64 {
        let has_pose = readings.pose.is_some() || self.before.is_some();
        let (Some(odometry), Some(measured_s), false) = (readings.odometry, self.measured_s, has_pose) else {
            return 0.0;
        };
        let gap_s = readings.stamp_s - measured_s - odometry.over_s;
        // The times of measurement vary by less than this.
        if gap_s > GAP_OF_MOTION * odometry.over_s { gap_s } else { 0.0 }
    }

    /// The motion that these readings report: since the last pose if they have one, otherwise since the readings before
    /// them. `None` if nothing is known.
    pub fn take(&mut self, readings: &Readings) -> Option<Odometry> {
        if readings.odometry.is_some() {
            self.measured_s = Some(readings.stamp_s);
        }
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
    fn lost_odometry_leaves_a_gap_unless_a_pose_makes_up_for_it() {
        let odometry = Odometry { over_s: 0.1, forward_m: 0.01, sideways_m: 0.0, turn_rad: 0.0 };
        let pose = Pose { x_m: 0.0, y_m: 0.0, heading_rad: 0.0 };
        for (pose, expected) in [(None, [0.0, 0.0, 0.3]), (Some(pose), [0.0, 0.0, 0.0])] {
            let mut motions = Motions::default();
            let gaps = [1.0, 1.12, 1.52].map(|stamp_s| {
                let readings = Readings { stamp_s, pose, odometry: Some(odometry), ..Readings::default() };
                let gap_s = motions.gap_s(&readings);
                motions.take(&readings);
                gap_s
            });
            assert!(gaps.iter().zip(expected).all(|(gap, is)| (gap - is).abs() < 1e-9), "{gaps:?}");
        }
    }

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
