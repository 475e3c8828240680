//! The effort of driving a path.

use planner_api::{Limits, Motion};
use serde::{Deserialize, Serialize};
use world::{Point, polyline};

/// The effort of driving a path at the robot's maximum speeds. The robot is assumed to drive straight between points and
/// to turn on the spot.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Effort {
    /// Length of the path, metres.
    pub length_m: f64,
    /// Sum of all changes of direction, radians.
    pub rotation_rad: f64,
    /// Mission time, seconds.
    pub time_s: f64,
}

impl Effort {
    /// Computes the effort of a path. A robot without a heading needs no time to turn.
    pub(crate) fn of(path: &[Point], limits: &Limits) -> Self {
        let length_m = polyline::length_m(path);
        let rotation_rad = polyline::turns_rad(path).sum();
        let turning_s = match limits.motion {
            Motion::Point => 0.0,
            Motion::Unicycle => rotation_rad / limits.w_max_rad_per_s,
        };
        Self { length_m, rotation_rad, time_s: length_m / limits.v_max_m_per_s + turning_s }
    }

    /// Describes the saving of this effort over the effort of the current plan from the same place on.
    pub fn saving(&self, present: &Self) -> String {
        let (less_s, less_m) = (present.time_s - self.time_s, present.length_m - self.length_m);
        let time = if less_s < 0.0 { "more" } else { "less" };
        let way = if less_m < 0.0 { "longer" } else { "shorter" };
        let (min, of_min) = (less_s.abs() / 60.0, present.time_s / 60.0);
        format!("{min:.1} min {time} (of {of_min:.1} remaining), {:.0} m {way}", less_m.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn turning_takes_time_unless_the_robot_has_no_heading() {
        let path =
            [(0.0, 0.0), (4.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 2.0)].map(|(x, y)| Point::new(x, y));
        let limits = |motion| Limits {
            motion,
            v_max_m_per_s: 0.4,
            w_max_rad_per_s: 0.5,
            radius_m: 0.3,
            sensing_range_m: 3.0,
            acceleration_m_per_s2: 0.5,
            tick_s: 0.1,
            amphibious: None,
        };
        let turning = Effort::of(&path, &limits(Motion::Unicycle));
        assert!((turning.length_m - 8.0).abs() < 1e-12 && (turning.rotation_rad - TAU / 2.0).abs() < 1e-12);
        assert!((turning.time_s - 20.0 - TAU).abs() < 1e-12);
        let straight = Effort::of(&path, &limits(Motion::Point));
        assert!((straight.time_s - 20.0).abs() < 1e-12);
        assert_eq!(straight.saving(&turning), "0.1 min less (of 0.4 remaining), 0 m shorter");
        assert_eq!(turning.saving(&straight), "0.1 min more (of 0.3 remaining), 0 m shorter");
        assert_eq!(Effort::of(&[], &limits(Motion::Point)), Effort::default());
    }
}
