//! Extended Kalman filter over position, heading, slip and gyro bias.

mod motion;
mod ranges;

use crate::fix::ellipse_95;
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use world::{Point, Pose, geometry::wrap_angle_rad};

/// Upper limit for the standard deviation of the position, metres; keeps the numbers finite.
const SIGMA_LIMIT_M: f64 = 1e4;
/// Lower limit for every variance.
const VARIANCE_FLOOR: f64 = 1e-14;
/// Normalised squared error beyond which a measurement of one, two or three values is refused. This refuses one correct
/// measurement in 10,000.
const GATE: [f64; 3] = [15.14, 18.42, 21.11];

/// Position, heading, share of the distance that is lost to slip, and error of the measured turn per tick.
pub(crate) type State = SVector<f64, 5>;
pub(crate) type Covariance = SMatrix<f64, 5, 5>;

/// The index of the slip in the state.
const SLIP: usize = 3;
/// The index of the turn error in the state.
const TURN_BIAS: usize = 4;
/// Upper limits for the standard deviations; they keep the numbers finite.
const SIGMA_LIMITS: [f64; 5] = [SIGMA_LIMIT_M, SIGMA_LIMIT_M, PI, 1.0, 0.1];

/// The errors of odometry.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MotionNoise {
    /// Standard deviation of the position after one metre without a fix, metres. Most of it is slip, so it grows in
    /// proportion to the distance until fixes show how large the slip is.
    pub sigma_per_m: f64,
    /// Standard deviation of a single motion as a share of that motion, independent for every motion.
    #[serde(default)]
    pub way_sigma_ratio: f64,
    /// Standard deviation of a turn as a share of the turn.
    pub turn_sigma_ratio: f64,
    /// Standard deviation of the turn that a robot at rest measures in a tick, radians. Most of it is the gyro's bias
    /// times the tick, so it adds up until fixes show how large the bias is.
    pub heading_sigma_per_tick_rad: f64,
    /// Probability, 0 to 1, that the tracks spin in a motion, so that most of the motion is lost.
    #[serde(default)]
    pub slip_chance: f64,
}

impl Default for MotionNoise {
    /// Tracks on a steel floor with a cheap gyro: 5 cm per metre, 5 % of a turn, 0.5 mrad per tick.
    fn default() -> Self {
        Self {
            sigma_per_m: 0.05,
            way_sigma_ratio: 0.0,
            turn_sigma_ratio: 0.05,
            heading_sigma_per_tick_rad: 0.0005,
            slip_chance: 0.0,
        }
    }
}

/// The outcome of an update with a measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Update {
    /// Squared difference between measured and expected value, in units of its variance.
    pub nis: f64,
    /// Whether the filter accepted the measurement.
    pub accepted: bool,
    /// The probability that the tracks spun in the previous motion, 0 to 1.
    pub slipped: f64,
}

impl Update {
    const REFUSED: Self = Self { nis: f64::MAX, accepted: false, slipped: 0.0 };

    fn refused(nis: f64) -> Self {
        Self { nis: if nis.is_finite() { nis } else { f64::MAX }, ..Self::REFUSED }
    }
}

/// A filter for the pose and its covariance, moved by odometry and corrected by fixes or single ranges.
///
/// Besides the pose, it estimates the slip and the gyro's bias, because both persist. Ranges alone contain no
/// information about the heading; it becomes known because motion correlates heading and position. Input that is not
/// a number is refused, so the state is always finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Ekf {
    state: State,
    covariance: Covariance,
    noise: MotionNoise,
    /// The last motion in the tank frame, metres.
    last_way: Vector2<f64>,
}

impl Ekf {
    /// Creates a filter at `start` with the given standard deviations, metres and radians.
    pub fn new(start: Pose, sigma_m: f64, heading_sigma_rad: f64, noise: MotionNoise) -> Self {
        let Pose { position, heading_rad } = start;
        let sigma = State::new(
            sigma_m,
            sigma_m,
            heading_sigma_rad,
            noise.sigma_per_m,
            noise.heading_sigma_per_tick_rad,
        );
        let mut filter = Self {
            state: State::new(position.x, position.y, heading_rad, 0.0, 0.0),
            // `min` also replaces NaN with the limit.
            covariance: Covariance::from_diagonal(
                &sigma.zip_map(&State::from(SIGMA_LIMITS), |s, limit| s.abs().min(limit).powi(2)),
            ),
            noise,
            last_way: Vector2::zeros(),
        };
        filter.keep_sound();
        filter
    }

    /// The estimated pose.
    pub fn pose(&self) -> Pose {
        Pose::new(self.state.x, self.state.y, self.state.z)
    }

    /// Covariance of x, y (square metres) and heading (square radians).
    pub fn covariance(&self) -> Matrix3<f64> {
        self.covariance.fixed_view::<3, 3>(0, 0).into_owned()
    }

    /// Covariance of the position, square metres.
    pub fn position_covariance(&self) -> Matrix2<f64> {
        self.covariance.fixed_view::<2, 2>(0, 0).into_owned()
    }

    /// Longer semi-axis of the 95 % ellipse of the position, metres.
    pub fn error_95_m(&self) -> f64 {
        ellipse_95(&self.position_covariance()).0
    }

    /// Corrects the estimate with a position and its covariance, unless the position is implausibly far off.
    pub fn update_position(&mut self, position: Point, covariance: &Matrix2<f64>) -> Update {
        let by_state = SMatrix::<f64, 2, 5>::identity();
        self.update(position - self.pose().position, by_state, *covariance)
    }

    /// Corrects the estimate with a pose and its covariance (square metres and square radians), unless the pose is
    /// implausibly far off.
    pub fn update_pose(&mut self, pose: &Pose, covariance: &Matrix3<f64>) -> Update {
        let here = self.pose();
        let off = pose.position - here.position;
        let turn_rad = wrap_angle_rad(pose.heading_rad - here.heading_rad);
        let by_state = SMatrix::<f64, 3, 5>::identity();
        self.update(SVector::<f64, 3>::new(off.x, off.y, turn_rad), by_state, *covariance)
    }

    /// Corrects the estimate with the range from one station, unless the range is implausibly far off.
    pub fn update_range(&mut self, station: Point, range_m: f64, sigma_m: f64) -> Update {
        let away = self.pose().position - station;
        let distance_m = away.norm();
        // So close to the station, the direction is undefined, and so is the correction.
        if distance_m < sigma_m {
            return Update::REFUSED;
        }
        let by_state = SMatrix::<f64, 1, 5>::new(away.x / distance_m, away.y / distance_m, 0.0, 0.0, 0.0);
        let variance = SMatrix::<f64, 1, 1>::new(sigma_m.powi(2));
        self.update(SVector::<f64, 1>::new(range_m - distance_m), by_state, variance)
    }

    pub(crate) fn state(&self) -> &State {
        &self.state
    }

    pub(crate) fn state_covariance(&self) -> &Covariance {
        &self.covariance
    }

    /// Sets the position and its covariance to those of a fix, whatever the previous estimate. Turns the heading by
    /// `turn_rad`, its known error, and increases its uncertainty by the standard deviation `heading_sigma_rad`.
    pub fn restart_at(
        &mut self,
        position: Point,
        covariance: &Matrix2<f64>,
        turn_rad: f64,
        heading_sigma_rad: f64,
    ) {
        let start = Pose { position, heading_rad: self.state.z + turn_rad };
        let heading_sigma_rad = (self.covariance[(2, 2)] + heading_sigma_rad.powi(2)).sqrt();
        let mut restarted = Self::new(start, 0.0, heading_sigma_rad, self.noise);
        restarted.covariance.fixed_view_mut::<2, 2>(0, 0).copy_from(covariance);
        self.adopt(restarted);
    }

    fn update<const N: usize>(
        &mut self,
        innovation: SVector<f64, N>,
        by_state: SMatrix<f64, N, 5>,
        noise: SMatrix<f64, N, N>,
    ) -> Update {
        let expected = by_state * self.covariance * by_state.transpose() + noise;
        let Some(inverse) = expected.try_inverse() else { return Update::REFUSED };
        let nis = (innovation.transpose() * inverse * innovation)[(0, 0)];
        // The comparison also refuses NaN.
        if !(0.0..=GATE[N - 1]).contains(&nis) {
            return Update::refused(nis);
        }
        let gain = self.covariance * by_state.transpose() * inverse;
        // The Joseph form stays positive where the short form may not.
        let rest = Covariance::identity() - gain * by_state;
        let covariance = rest * self.covariance * rest.transpose() + gain * noise * gain.transpose();
        let updated = Self { state: self.state + gain * innovation, covariance, ..self.clone() };
        Update { nis, accepted: self.adopt(updated), slipped: 0.0 }
    }

    /// Adopts a new state if it is valid; returns whether it is.
    fn adopt(&mut self, mut new: Self) -> bool {
        let is_sound = new.covariance.iter().chain(new.state.iter()).all(|number| number.abs() < 1e100);
        if is_sound {
            new.keep_sound();
            *self = new;
        }
        is_sound
    }

    /// Keeps the covariance symmetric, non-negative and bounded, the heading within one turn, and the slip below a
    /// total loss of motion.
    fn keep_sound(&mut self) {
        self.state[2] = wrap_angle_rad(self.state[2]);
        self.state[SLIP] = self.state[SLIP].clamp(-0.5, 0.9);
        let symmetric = (self.covariance + self.covariance.transpose()) / 2.0;
        let limits = State::from(SIGMA_LIMITS);
        let shrink = Covariance::from_diagonal(&limits.zip_map(&symmetric.diagonal(), |limit, variance| {
            if variance > limit * limit { limit / variance.sqrt() } else { 1.0 }
        }));
        self.covariance = shrink * symmetric * shrink;
        for i in 0..5 {
            self.covariance[(i, i)] = self.covariance[(i, i)].max(VARIANCE_FLOOR);
        }
        for (i, j) in (1..5).flat_map(|i| (0..i).map(move |j| (i, j))) {
            let most = (self.covariance[(i, i)] * self.covariance[(j, j)]).sqrt();
            self.covariance[(i, j)] = self.covariance[(i, j)].clamp(-most, most);
            self.covariance[(j, i)] = self.covariance[(i, j)];
        }
    }
}

#[cfg(test)]
mod tests;
