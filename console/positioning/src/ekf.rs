//! Extended Kalman filter over position, heading, slip and gyro bias.

use crate::{
    anchor::{Anchor, anchored},
    fix::{Ranging, ellipse_95},
    nonlinear::{Slope, information_at},
    quality::{chi_squared_quantile, inverse_of},
};
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use world::{Odometry, Point, Pose, Station, geometry::wrap_angle_rad};

/// No position is less known than this, metres; keeps the numbers finite.
const SIGMA_LIMIT_M: f64 = 1e4;
/// No variance is smaller than this.
const VARIANCE_FLOOR: f64 = 1e-14;
/// Odometry of one tick beyond this is no motion of a robot, metres or radians.
const MOTION_LIMIT: f64 = 1e3;
/// Squared distance in sigmas per degree of freedom beyond which a measurement is refused: one honest one in 10 000.
const GATE: [f64; 2] = [15.14, 18.42];

/// The same as a normal quantile, for any number of ranges.
const GATE_Z: f64 = 3.719;
/// Steps of an iterated update; three are usual.
const UPDATE_STEPS: usize = 12;
/// It ends when a step is shorter than this, metres.
const SETTLED_M: f64 = 1e-5;

/// Position, heading, share of the way lost to slip, error of the measured turn per tick.
pub(crate) type State = SVector<f64, 5>;
pub(crate) type Covariance = SMatrix<f64, 5, 5>;

/// Where in the state the slip stands.
const SLIP: usize = 3;
/// Where in the state the error of the turn stands.
const TURN_BIAS: usize = 4;
/// Standard deviations beyond which nothing is less known; they keep the numbers finite.
const SIGMA_LIMITS: [f64; 5] = [SIGMA_LIMIT_M, SIGMA_LIMIT_M, PI, 1.0, 0.1];
/// Part of the odometry error that is fresh in every metre, as a share of the part that stays the same.
const FRESH_SHARE: f64 = 0.3;
/// Fresh odometry error across the way as a share of that along it.
const ACROSS_SHARE: f64 = 0.3;
/// Part of a motion that is lost when tracks slip through, on average, and its standard deviation.
const SLIPPED_THROUGH: (f64, f64) = (0.5, 0.2);
/// Change of slip and turn error within a metre, as a share of what they may be.
const WANDER_SHARE: f64 = 0.05;

/// How odometry errs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MotionNoise {
    /// Standard deviation of the position after one metre without a fix, metres; mostly slip, so it grows in
    /// proportion to the way until fixes show how large the slip is.
    pub sigma_per_m: f64,
    /// Standard deviation of a single motion as a share of it, fresh in every motion.
    #[serde(default)]
    pub way_sigma_ratio: f64,
    /// Standard deviation of a turn as a share of the turn.
    pub turn_sigma_ratio: f64,
    /// Standard deviation of the turn that a robot at rest measures in a tick, radians; mostly the gyro's bias times
    /// the tick, so it adds up until fixes show how large it is.
    pub heading_sigma_per_tick_rad: f64,
    /// Chance that the tracks slip through in a motion and it is mostly lost, 0 to 1.
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

/// What became of a measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Update {
    /// Squared difference to the expectation in its own sigmas.
    pub nis: f64,
    /// Whether the filter took it.
    pub accepted: bool,
    /// How likely the tracks slipped through in the motion before, 0 to 1.
    pub slipped: f64,
}

impl Update {
    const REFUSED: Self = Self { nis: f64::MAX, accepted: false, slipped: 0.0 };

    fn refused(nis: f64) -> Self {
        Self { nis: if nis.is_finite() { nis } else { f64::MAX }, ..Self::REFUSED }
    }
}

/// The filter: pose with covariance, moved by odometry, corrected by fixes or single ranges.
///
/// Besides the pose it estimates the slip and the gyro's bias, because both last. Ranges say nothing about the heading
/// by themselves; it becomes known through the correlation that motion makes between heading and position. Input that
/// is no number is refused, so the state always is finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Ekf {
    state: State,
    covariance: Covariance,
    noise: MotionNoise,
    /// The last motion in the tank frame, metres.
    last_way: Vector2<f64>,
}

impl Ekf {
    /// A filter that believes in `start` with the given standard deviations, metres and radians.
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
            // `min` also turns what is no number into the limit.
            covariance: Covariance::from_diagonal(
                &sigma.zip_map(&State::from(SIGMA_LIMITS), |s, limit| s.abs().min(limit).powi(2)),
            ),
            noise,
            last_way: Vector2::zeros(),
        };
        filter.keep_sound();
        filter
    }

    /// Where the robot is believed to be.
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

    /// Longer half axis of the 95 % ellipse of the position, metres.
    pub fn error_95_m(&self) -> f64 {
        ellipse_95(&self.position_covariance()).0
    }

    /// Moves the belief by what the odometry says.
    pub fn predict(&mut self, odometry: &Odometry) {
        self.moved_by(odometry);
    }

    /// Moves the belief; gives what the state after the motion depends on of the state before.
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
        // The heading turns evenly on the way, so the position sees half of it.
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

    /// Takes back most of the fresh variance across the way: tracks err along it, and the heading does the rest.
    fn narrow_across(&mut self, step: Vector2<f64>, gained_m2: f64) {
        if let Some(along) = step.try_normalize(1e-9) {
            let across = Vector2::new(-along.y, along.x);
            let taken = across * across.transpose() * (gained_m2 * (1.0 - ACROSS_SHARE.powi(2)));
            let mut position = self.covariance.fixed_view_mut::<2, 2>(0, 0);
            position -= taken;
        }
    }

    /// Variances that a motion adds.
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

    /// Corrects by a position with its covariance, unless it is too far off to be true.
    pub fn update_position(&mut self, position: Point, covariance: &Matrix2<f64>) -> Update {
        let by_state = SMatrix::<f64, 2, 5>::identity();
        self.update(position - self.pose().position, by_state, *covariance)
    }

    /// Corrects by the range from one station, unless it is too far off to be true.
    pub fn update_range(&mut self, station: Point, range_m: f64, sigma_m: f64) -> Update {
        let away = self.pose().position - station;
        let distance_m = away.norm();
        // From this near the direction, and with it the correction, is anyone's guess.
        if distance_m < sigma_m {
            return Update::REFUSED;
        }
        let by_state = SMatrix::<f64, 1, 5>::new(away.x / distance_m, away.y / distance_m, 0.0, 0.0, 0.0);
        let variance = SMatrix::<f64, 1, 1>::new(sigma_m.powi(2));
        self.update(SVector::<f64, 1>::new(range_m - distance_m), by_state, variance)
    }

    /// Corrects by all ranges of a cycle at once, unless they are too far off to be true.
    ///
    /// The position that fits belief and ranges best is searched for (an iterated update), so bent range circles are
    /// no matter; heading, slip and bias follow by their correlation with the position. Ranges of unknown stations
    /// are left out.
    pub fn update_ranges(&mut self, ranges: &[Ranging], stations: &[Station]) -> Update {
        let Ok(anchors) = anchored(ranges, stations) else { return Update::REFUSED };
        let degrees = u32::try_from(anchors.len()).unwrap_or(u32::MAX);
        let gate = chi_squared_quantile(GATE_Z, degrees);
        // The comparison also refuses what is no number.
        let met = |filter: &Self| filter.meeting(&anchors).filter(|(_, met)| met.cost <= gate);
        let slip_chance =
            if self.last_way.norm() > 0.0 { self.noise.slip_chance.clamp(0.0, 0.5) } else { 0.0 };
        let gripped = met(self);
        let slipped = if slip_chance > 0.0 { met(&self.slipped_through(1.0)) } else { None };
        let (updated, nis, share) = match (gripped, slipped) {
            (None, None) => {
                return Update::refused(self.meeting(&anchors).map_or(f64::MAX, |(_, met)| met.cost));
            }
            (Some((updated, met)), None) => (updated, met.cost, 0.0),
            (None, Some((updated, met))) => (updated, met.cost, 1.0),
            (Some((held, met_held)), Some((lost, met_lost))) => {
                let odds = (met_lost.log_evidence - met_held.log_evidence).clamp(-50.0, 50.0).exp();
                let share = slip_chance * odds / (1.0 - slip_chance + slip_chance * odds);
                (held.mixed_with(&lost, share), met_held.cost.min(met_lost.cost), share)
            }
        };
        let accepted = self.adopt(updated);
        self.last_way = Vector2::zeros();
        Update { nis, accepted, slipped: share }
    }

    /// The belief if the tracks slipped through in the last motion, as far as `share` says.
    pub(crate) fn slipped_through(&self, share: f64) -> Self {
        let (mean, sigma) = SLIPPED_THROUGH;
        let mut lost = self.clone();
        let mut position = lost.state.fixed_rows_mut::<2>(0);
        position -= self.last_way * (mean * share);
        let mut covariance = lost.covariance.fixed_view_mut::<2, 2>(0, 0);
        let variance = share * sigma * sigma + share * (1.0 - share) * mean * mean;
        covariance += self.last_way * self.last_way.transpose() * variance;
        lost
    }

    /// The belief after it met the ranges, and how well they met.
    fn meeting(&self, anchors: &[Anchor]) -> Option<(Self, Meeting)> {
        let prior = self.position_covariance();
        let belief = inverse_of(&prior)?;
        let mut met = best_of_belief_and_ranges(anchors, self.pose().position, &belief)?;
        met.log_evidence = 0.5 * ((met.covariance.determinant() / prior.determinant()).ln() - met.cost);
        Some((self.with_position(met.position, &met.covariance, &belief), met))
    }

    /// One belief with the mean and covariance of two, of which the other has the given share.
    fn mixed_with(&self, other: &Self, share: f64) -> Self {
        let state = self.state * (1.0 - share) + other.state * share;
        let spread = |filter: &Self| {
            let off = filter.state - state;
            filter.covariance + off * off.transpose()
        };
        let covariance = spread(self) * (1.0 - share) + spread(other) * share;
        Self { state, covariance, ..self.clone() }
    }

    /// The belief after its position has become known better; the rest follows by correlation.
    fn with_position(&self, position: Point, covariance: &Matrix2<f64>, belief: &Matrix2<f64>) -> Self {
        let gain = self.covariance.fixed_view::<5, 2>(0, 0) * belief;
        let lost = self.position_covariance() - covariance;
        Self {
            state: self.state + gain * (position - self.pose().position),
            covariance: self.covariance - gain * lost * gain.transpose(),
            ..self.clone()
        }
    }

    pub(crate) fn state(&self) -> &State {
        &self.state
    }

    pub(crate) fn state_covariance(&self) -> &Covariance {
        &self.covariance
    }

    /// Makes the position as uncertain as if the tracks had slipped all the way of the last motion.
    ///
    /// For a filter whose ranges were refused while the solver finds them sound.
    pub fn doubt_motion(&mut self, odometry: &Odometry) {
        let way_m = odometry.forward_m.hypot(odometry.sideways_m);
        if way_m <= MOTION_LIMIT {
            self.covariance[(0, 0)] += way_m * way_m;
            self.covariance[(1, 1)] += way_m * way_m;
            self.keep_sound();
        }
    }

    /// Puts the position where a fix says it is, whatever was believed, and doubts the heading.
    pub fn restart_at(&mut self, position: Point, covariance: &Matrix2<f64>, heading_sigma_rad: f64) {
        let start = Pose { position, heading_rad: self.state.z };
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
        // The comparison also refuses what is no number.
        if !(0.0..=GATE[N - 1]).contains(&nis) {
            return Update::refused(nis);
        }
        let gain = self.covariance * by_state.transpose() * inverse;
        // Joseph's form stays positive where the short form may not.
        let rest = Covariance::identity() - gain * by_state;
        let covariance = rest * self.covariance * rest.transpose() + gain * noise * gain.transpose();
        let updated = Self { state: self.state + gain * innovation, covariance, ..self.clone() };
        Update { nis, accepted: self.adopt(updated), slipped: 0.0 }
    }

    /// Takes a new state if it is sound.
    fn adopt(&mut self, mut new: Self) -> bool {
        let is_sound = new.covariance.iter().chain(new.state.iter()).all(|number| number.abs() < 1e100);
        if is_sound {
            new.keep_sound();
            *self = new;
        }
        is_sound
    }

    /// Covariance symmetric, not negative, not endless; the heading within one turn, the slip short of standing still.
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

/// Where belief and ranges meet.
struct Meeting {
    position: Point,
    covariance: Matrix2<f64>,
    cost: f64,
    /// Logarithm of the likelihood of the ranges under the belief, up to what only depends on the ranges.
    log_evidence: f64,
}

/// Goes down the sum of the squared errors of belief and ranges; `belief` is the inverse of its covariance.
fn best_of_belief_and_ranges(anchors: &[Anchor], start: Point, belief: &Matrix2<f64>) -> Option<Meeting> {
    let cost_at = |slope: &Slope, at: Point| slope.cost + (at - start).dot(&(belief * (at - start)));
    let (mut position, mut damping) = (start, 0.0);
    let mut slope = Slope::at(anchors, position);
    let mut cost = cost_at(&slope, position);
    for _ in 0..UPDATE_STEPS {
        let curvature = slope.curvature + belief;
        let damped = curvature + Matrix2::identity() * (damping * curvature.trace());
        let step = inverse_of(&damped)? * -(slope.gradient + belief * (position - start));
        let there = Slope::at(anchors, position + step);
        let cost_there = cost_at(&there, position + step);
        if cost_there <= cost {
            (position, slope, cost) = (position + step, there, cost_there);
            damping *= 0.1;
        } else {
            damping = (damping * 10.0).max(1e-2);
        }
        if step.norm() < SETTLED_M {
            break;
        }
    }
    let covariance = inverse_of(&(information_at(anchors, position) + belief))?;
    Some(Meeting { position, covariance, cost, log_evidence: 0.0 })
}

#[cfg(test)]
mod tests;
