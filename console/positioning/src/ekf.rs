//! Extended Kalman filter over position and heading.

use crate::fix::ellipse_95;
use nalgebra::{Matrix2, Matrix3, RowVector3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use world::{Odometry, Point, Pose, geometry::wrap_angle_rad};

/// No position is less known than this, metres; keeps the numbers finite.
const SIGMA_LIMIT_M: f64 = 1e4;
/// Odometry of one tick beyond this is no motion of a robot, metres or radians.
const MOTION_LIMIT: f64 = 1e3;
/// Squared distance in sigmas per degree of freedom beyond which a measurement is refused: one honest one in 10 000.
const GATE: [f64; 2] = [15.14, 18.42];

/// How odometry errs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MotionNoise {
    /// Standard deviation of the position after one metre without a fix, metres.
    pub sigma_per_m: f64,
    /// Standard deviation of a turn as a share of the turn.
    pub turn_sigma_ratio: f64,
    /// Standard deviation that the heading gathers in one tick, radians.
    pub heading_sigma_per_tick_rad: f64,
}

/// What became of a measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Update {
    /// Squared difference to the expectation in its own sigmas.
    pub nis: f64,
    /// Whether the filter took it.
    pub accepted: bool,
}

impl Update {
    const REFUSED: Self = Self { nis: f64::MAX, accepted: false };
}

/// The filter: pose with covariance, moved by odometry, corrected by fixes or single ranges.
///
/// Ranges say nothing about the heading by themselves; it becomes known through the correlation that motion makes
/// between heading and position. Input that is no number is refused, so the state always is finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Ekf {
    pose: Pose,
    covariance: Matrix3<f64>,
    way_since_update_m: f64,
}

impl Ekf {
    /// A filter that believes in `start` with the given standard deviations, metres and radians.
    pub fn new(start: Pose, sigma_m: f64, heading_sigma_rad: f64) -> Self {
        let covariance =
            Matrix3::from_diagonal(&Vector3::new(sigma_m, sigma_m, heading_sigma_rad).map(|s| s * s));
        let mut filter = Self { pose: start, covariance, way_since_update_m: 0.0 };
        filter.keep_sound();
        filter
    }

    /// Where the robot is believed to be.
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// Covariance of x, y (square metres) and heading (square radians).
    pub fn covariance(&self) -> &Matrix3<f64> {
        &self.covariance
    }

    /// Covariance of the position, square metres.
    pub fn position_covariance(&self) -> Matrix2<f64> {
        self.covariance.fixed_view::<2, 2>(0, 0).into_owned()
    }

    /// Longer half axis of the 95 % ellipse of the position, metres.
    pub fn error_95_m(&self) -> f64 {
        ellipse_95(&self.position_covariance()).0
    }

    /// Moves the belief by what the odometry says.
    ///
    /// The position error grows in proportion to the way since the last measurement, not with its root: slip is
    /// much the same from tick to tick.
    pub fn predict(&mut self, odometry: &Odometry, noise: &MotionNoise) {
        let Odometry { forward_m, sideways_m, turn_rad } = *odometry;
        if ![forward_m, sideways_m, turn_rad].iter().all(|m| m.abs() <= MOTION_LIMIT) {
            return;
        }
        let before = self.pose.position;
        self.pose = self.pose.moved(forward_m, sideways_m, turn_rad);
        let step = self.pose.position - before;
        let by_state = Matrix3::new(1.0, 0.0, -step.y, 0.0, 1.0, step.x, 0.0, 0.0, 1.0);
        let way_m = self.way_since_update_m + forward_m.hypot(sideways_m);
        let gained = noise.sigma_per_m.powi(2) * (way_m.powi(2) - self.way_since_update_m.powi(2));
        let turned = (noise.turn_sigma_ratio * turn_rad).powi(2) + noise.heading_sigma_per_tick_rad.powi(2);
        self.way_since_update_m = way_m;
        self.covariance = by_state * self.covariance * by_state.transpose()
            + Matrix3::from_diagonal(&Vector3::new(gained, gained, turned));
        self.keep_sound();
    }

    /// Corrects by a position with its covariance, unless it is too far off to be true.
    pub fn update_position(&mut self, position: Point, covariance: &Matrix2<f64>) -> Update {
        let by_state = SMatrix::<f64, 2, 3>::identity();
        self.update(position - self.pose.position, by_state, *covariance)
    }

    /// Corrects by the range from one station, unless it is too far off to be true.
    pub fn update_range(&mut self, station: Point, range_m: f64, sigma_m: f64) -> Update {
        let away = self.pose.position - station;
        let distance_m = away.norm();
        if distance_m < sigma_m {
            return Update::REFUSED;
        }
        let by_state = RowVector3::new(away.x / distance_m, away.y / distance_m, 0.0);
        self.update(
            SVector::<f64, 1>::new(range_m - distance_m),
            by_state,
            SMatrix::<f64, 1, 1>::new(sigma_m.powi(2)),
        )
    }

    /// Puts the position where a fix says it is, whatever was believed, and doubts the heading.
    pub fn restart_at(&mut self, position: Point, covariance: &Matrix2<f64>, heading_sigma_rad: f64) {
        let heading_variance = self.covariance[(2, 2)] + heading_sigma_rad.powi(2);
        let mut restarted = Self { way_since_update_m: 0.0, ..self.clone() };
        restarted.pose.position = position;
        restarted.covariance = Matrix3::zeros();
        restarted.covariance.fixed_view_mut::<2, 2>(0, 0).copy_from(covariance);
        restarted.covariance[(2, 2)] = heading_variance;
        self.adopt(restarted);
    }

    fn update<const N: usize>(
        &mut self,
        innovation: SVector<f64, N>,
        by_state: SMatrix<f64, N, 3>,
        noise: SMatrix<f64, N, N>,
    ) -> Update {
        let expected = by_state * self.covariance * by_state.transpose() + noise;
        let Some(inverse) = expected.try_inverse() else { return Update::REFUSED };
        let nis = (innovation.transpose() * inverse * innovation)[(0, 0)];
        // The comparison also refuses what is no number.
        if !(0.0..=GATE[N - 1]).contains(&nis) {
            return Update { nis: if nis.is_finite() { nis } else { f64::MAX }, accepted: false };
        }
        let gain = self.covariance * by_state.transpose() * inverse;
        let shift = gain * innovation;
        let mut updated = Self { way_since_update_m: 0.0, ..self.clone() };
        updated.pose.position += shift.fixed_rows::<2>(0);
        updated.pose.heading_rad += shift[2];
        // Joseph's form stays positive where the short form may not.
        let rest = Matrix3::identity() - gain * by_state;
        updated.covariance = rest * self.covariance * rest.transpose() + gain * noise * gain.transpose();
        Update { nis, accepted: self.adopt(updated) }
    }

    /// Takes a new state if it is sound.
    fn adopt(&mut self, mut new: Self) -> bool {
        let is_finite = new.covariance.iter().all(|c| c.is_finite())
            && new.pose.position.iter().all(|c| c.is_finite())
            && new.pose.heading_rad.is_finite();
        if is_finite {
            new.keep_sound();
            *self = new;
        }
        is_finite
    }

    /// Symmetric, not negative, not endless; the heading within one turn.
    fn keep_sound(&mut self) {
        self.pose.heading_rad = wrap_angle_rad(self.pose.heading_rad);
        let symmetric = (self.covariance + self.covariance.transpose()) / 2.0;
        let limits = Vector3::new(SIGMA_LIMIT_M, SIGMA_LIMIT_M, PI);
        let shrink = Matrix3::from_diagonal(&limits.zip_map(&symmetric.diagonal(), |limit, variance| {
            if variance > limit * limit { limit / variance.sqrt() } else { 1.0 }
        }));
        self.covariance = shrink * symmetric * shrink;
        for i in 0..3 {
            self.covariance[(i, i)] = self.covariance[(i, i)].max(1e-12);
        }
    }
}

#[cfg(test)]
mod tests;
