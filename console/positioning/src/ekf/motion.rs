//! Moves the estimate according to the odometry.

use super::{Covariance, Ekf, SLIP, State, TURN_BIAS};
use crate::fix::ELLIPSE_95;
use nalgebra::{Matrix2, Vector2};
use world::Odometry;

/// The largest plausible motion in one tick, metres or radians; larger odometry is refused.
const MOTION_LIMIT: f64 = 1e3;
/// The part of the odometry error that is independent from metre to metre, as a share of the persistent part.
const FRESH_SHARE: f64 = 0.3;
/// Independent odometry error across the path, as a share of the error along the path.
const ACROSS_SHARE: f64 = 0.3;
/// Half width of the 95 % interval of a normal distribution, in standard deviations.
const HALF_WIDTH_95: f64 = 1.96;
/// Standard deviation of the heading, radians, above which the direction of a motion is unknown.
const LOST_HEADING_RAD: f64 = 0.35;
/// Drift of slip and turn error within a metre, as a share of their standard deviations.
const WANDER_SHARE: f64 = 0.05;

impl Ekf {
    /// Moves the estimate according to the odometry.
    pub fn predict(&mut self, odometry: &Odometry) {
        self.moved_by(odometry);
    }

    /// Moves the estimate; returns the derivative of the new state with respect to the old one.
    pub(crate) fn moved_by(&mut self, odometry: &Odometry) -> Covariance {
        let Odometry { forward_m, sideways_m, turn_rad } = *odometry;
        if ![forward_m, sideways_m, turn_rad].iter().all(|m| m.abs() <= MOTION_LIMIT) {
            return Covariance::identity();
        }
        let before = self.pose();
        let kept = 1.0 - self.state[SLIP];
        let after = before.moved(forward_m * kept, sideways_m * kept, turn_rad - self.state[TURN_BIAS]);
        let unslipped = before.moved(forward_m, sideways_m, turn_rad).position - before.position;
        let step = after.position - before.position;
        self.state.fixed_rows_mut::<2>(0).copy_from(&after.position.coords);
        self.state[2] = after.heading_rad;

        let mut by_state = Covariance::identity();
        let by_heading = Vector2::new(-step.y, step.x);
        by_state.fixed_view_mut::<2, 1>(0, 2).copy_from(&by_heading);
        by_state.fixed_view_mut::<2, 1>(0, SLIP).copy_from(&-unslipped);
        // The heading turns evenly during the motion, so half of the turn affects the position.
        by_state.fixed_view_mut::<2, 1>(0, TURN_BIAS).copy_from(&(by_heading * -0.5));
        by_state[(2, TURN_BIAS)] = -1.0;
        let gained = self.gained_m2_rad2(forward_m.hypot(sideways_m), turn_rad);
        self.covariance =
            by_state * self.covariance * by_state.transpose() + Covariance::from_diagonal(&gained);
        self.narrow_across(step, gained[0]);
        self.last_way = step;
        self.keep_sound();
        by_state
    }

    /// Removes most of the independent variance across the path: tracks err along the path, and the heading error
    /// accounts for the remaining error.
    fn narrow_across(&mut self, step: Vector2<f64>, gained_m2: f64) {
        if let Some(along) = step.try_normalize(1e-9) {
            let across = Vector2::new(-along.y, along.x);
            let taken = across * across.transpose() * (gained_m2 * (1.0 - ACROSS_SHARE.powi(2)));
            let mut position = self.covariance.fixed_view_mut::<2, 2>(0, 0);
            position -= taken;
        }
    }

    /// Returns the variances that a motion adds.
    fn gained_m2_rad2(&self, way_m: f64, turn_rad: f64) -> State {
        let noise = &self.noise;
        let by_way =
            (FRESH_SHARE * noise.sigma_per_m).powi(2) * way_m + (noise.way_sigma_ratio * way_m).powi(2);
        let by_turn = (noise.turn_sigma_ratio * turn_rad).powi(2) + noise.heading_sigma_per_tick_rad.powi(2);
        let wander = WANDER_SHARE.powi(2) * way_m;
        State::new(
            by_way,
            by_way,
            by_turn,
            noise.sigma_per_m.powi(2) * wander,
            noise.heading_sigma_per_tick_rad.powi(2) * wander,
        )
    }

    /// Widens the estimate for an unmeasured motion of at most `most_m` metres in any direction and at most
    /// `most_rad` radians.
    ///
    /// Every place in the 95 % ellipse, moved by up to `most_m`, lies in the new ellipse; its longer semi-axis is
    /// longer by exactly `most_m`. Of all ellipses that contain the sum of an ellipse and a disc (Kurzhanski), this one
    /// has the shortest longer axis. Several short motions give the same result as one long motion. Here, the
    /// covariance is a bound, not a probability: a robot that drives straight at its top speed is at the rim.
    pub fn wander(&mut self, most_m: f64, most_rad: f64) {
        // More than this is as good as lost; a bound that is not a number is none.
        let bounded = |most: f64| if most.is_nan() { MOTION_LIMIT } else { most.clamp(0.0, MOTION_LIMIT) };
        let (most_m, most_rad) = (bounded(most_m), bounded(most_rad));
        let half_m = self.error_95_m().max(1e-9);
        let stretch = (half_m + most_m) / half_m;
        let mut stretched = Covariance::identity();
        stretched.fixed_view_mut::<2, 2>(0, 0).copy_from(&(Matrix2::identity() * stretch.sqrt()));
        self.covariance = stretched * self.covariance * stretched;
        let mut position = self.covariance.fixed_view_mut::<2, 2>(0, 0);
        position += Matrix2::identity() * ((half_m + most_m) * most_m / ELLIPSE_95);
        let heading_sigma_rad = self.covariance[(2, 2)].sqrt() + most_rad / HALF_WIDTH_95;
        self.covariance[(2, 2)] = heading_sigma_rad * heading_sigma_rad;
        self.keep_sound();
    }

    /// Moves the estimate according to the odometry when the heading may be lost, so that only the length of the motion
    /// counts.
    pub fn predict_unsure(&mut self, odometry: &Odometry) {
        let way_m = odometry.forward_m.hypot(odometry.sideways_m);
        let is_lost = self.covariance[(2, 2)] > LOST_HEADING_RAD * LOST_HEADING_RAD;
        self.moved_by(odometry);
        if is_lost {
            // The robot may have moved in the opposite direction.
            self.wander(2.0 * way_m, 0.0);
        }
    }

    /// Makes the position as uncertain as if the tracks had spun during the whole last motion.
    ///
    /// Intended for a filter that has refused ranges that the solver accepts.
    pub fn doubt_motion(&mut self, odometry: &Odometry) {
        let way_m = odometry.forward_m.hypot(odometry.sideways_m);
        if way_m <= MOTION_LIMIT {
            self.covariance[(0, 0)] += way_m * way_m;
            self.covariance[(1, 1)] += way_m * way_m;
            self.keep_sound();
        }
    }
}
