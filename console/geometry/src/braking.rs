//! The one law of braking, used by the mission, by planners and for time estimates. It gives the distance that a robot
//! needs to stop, and the maximum speed at which it can still stop, or slow down, within a given distance.
//!
//! A robot that is ordered to brake continues at its speed for up to one tick, and then slows down at its maximum
//! deceleration.

use crate::Limits;

/// The braking capability of a robot.
///
/// ```
/// use geometry::Braking;
/// let braking = Braking { acceleration_m_per_s2: 0.5, tick_s: 0.1 };
/// // A tick at 0.4 m/s, and 0.4² / (2 × 0.5) m until it stands.
/// assert!((braking.distance_m(0.4) - 0.20).abs() < 1e-12);
/// assert!((braking.speed_within(0.20) - 0.4).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Braking {
    /// Maximum deceleration, metres per second squared.
    pub acceleration_m_per_s2: f64,
    /// Delay until a command takes effect: one tick, seconds.
    pub tick_s: f64,
}

impl Braking {
    /// The braking capability of a robot with these limits.
    ///
    /// ```
    /// use geometry::{Braking, Limits, Motion};
    /// let (motion, v_max_m_per_s, w_max_rad_per_s, radius_m) = (Motion::Unicycle, 0.4, 1.0, 0.2);
    /// let (sensing_range_m, acceleration_m_per_s2, tick_s, amphibious) = (2.0, 0.5, 0.1, None);
    /// let limits = Limits {
    ///     motion, v_max_m_per_s, w_max_rad_per_s, radius_m, sensing_range_m, acceleration_m_per_s2, tick_s,
    ///     amphibious,
    /// };
    /// assert_eq!(Braking::of(&limits).tick_s, 0.1);
    /// ```
    pub fn of(limits: &Limits) -> Self {
        Self { acceleration_m_per_s2: limits.acceleration_m_per_s2.max(0.0), tick_s: limits.tick_s.max(0.0) }
    }

    /// Distance that a robot travels from the moment it begins to brake until it has stopped, metres; infinite if it
    /// cannot brake.
    ///
    /// ```
    /// use geometry::Braking;
    /// let braking = Braking { acceleration_m_per_s2: 0.5, tick_s: 0.1 };
    /// assert!((braking.way_m(0.4) - 0.16).abs() < 1e-12);
    /// assert_eq!(braking.way_m(0.0), 0.0);
    /// ```
    pub fn way_m(&self, speed_m_per_s: f64) -> f64 {
        if speed_m_per_s == 0.0 {
            return 0.0;
        }
        speed_m_per_s * speed_m_per_s / (2.0 * self.acceleration_m_per_s2)
    }

    /// Stopping distance of a robot that is ordered to brake now, including the tick before it begins to brake, metres.
    ///
    /// ```
    /// use geometry::Braking;
    /// let lazy = Braking { acceleration_m_per_s2: 0.2, tick_s: 0.1 };
    /// assert!((lazy.distance_m(0.4) - 0.44).abs() < 1e-12);
    /// ```
    pub fn distance_m(&self, speed_m_per_s: f64) -> f64 {
        speed_m_per_s.abs() * self.tick_s + self.way_m(speed_m_per_s)
    }

    /// The maximum speed from which a robot can stop within a distance, metres per second.
    ///
    /// ```
    /// use geometry::Braking;
    /// let braking = Braking { acceleration_m_per_s2: 0.5, tick_s: 0.1 };
    /// assert_eq!(braking.speed_within(-0.1), 0.0);
    /// assert!(braking.distance_m(braking.speed_within(0.05)) <= 0.05 + 1e-12);
    /// ```
    pub fn speed_within(&self, distance_m: f64) -> f64 {
        self.speed_before(distance_m, 0.0)
    }

    /// The maximum speed from which a robot can slow down to `then_m_per_s` within `distance_m`, metres per second.
    ///
    /// ```
    /// use geometry::Braking;
    /// let braking = Braking { acceleration_m_per_s2: 0.5, tick_s: 0.1 };
    /// assert_eq!(braking.speed_before(0.0, 0.2), 0.2);
    /// assert!(braking.speed_before(1.0, 0.2) > braking.speed_within(1.0));
    /// ```
    pub fn speed_before(&self, distance_m: f64, then_m_per_s: f64) -> f64 {
        // From v t + (v² - u²) / 2a = d.
        let per_tick = self.acceleration_m_per_s2 * self.tick_s;
        let squares = per_tick * per_tick
            + 2.0 * self.acceleration_m_per_s2 * distance_m.max(0.0)
            + then_m_per_s * then_m_per_s;
        (squares.sqrt() - per_tick).max(then_m_per_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_robot_that_brakes_when_it_is_told_to_stands_in_time(
            free_m in 0.0..5.0_f64, acceleration_m_per_s2 in 0.05..2.0_f64, tick_s in 0.05..0.5_f64,
        ) {
            let braking = Braking { acceleration_m_per_s2, tick_s };
            let mut speed = braking.speed_within(free_m);
            let mut way_m = speed * tick_s;
            while speed > 0.0 {
                speed = (speed - acceleration_m_per_s2 * tick_s).max(0.0);
                way_m += speed * tick_s;
            }
            prop_assert!(way_m <= free_m + 1e-9, "{way_m} of {free_m}");
        }

        #[test]
        fn distance_and_speed_are_inverse(
            speed in 0.0..2.0_f64, acceleration_m_per_s2 in 0.05..2.0_f64, tick_s in 0.01..0.5_f64,
        ) {
            let braking = Braking { acceleration_m_per_s2, tick_s };
            prop_assert!((braking.speed_within(braking.distance_m(speed)) - speed).abs() < 1e-9);
        }

        #[test]
        fn a_robot_is_as_slow_as_it_has_to_be(
            free_m in 0.0..5.0_f64, then in 0.0..0.5_f64, acceleration_m_per_s2 in 0.05..2.0_f64, tick_s in 0.05..0.5_f64,
        ) {
            let braking = Braking { acceleration_m_per_s2, tick_s };
            let mut speed = braking.speed_before(free_m, then);
            let mut way_m = speed * tick_s;
            while speed > then + 1e-9 {
                prop_assert!(way_m <= free_m + 1e-9, "{speed} after {way_m} of {free_m}");
                speed = (speed - acceleration_m_per_s2 * tick_s).max(then);
                way_m += speed * tick_s;
            }
        }
    }
}
