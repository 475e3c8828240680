//! Tracks many guesses at the pose, and keeps those that explain the ranges.

use crate::{
    bounded::Bounded,
    ekf::MotionNoise,
    fix::{FixError, PositionSolver, Ranging},
};
use nalgebra::{Matrix2, Matrix3};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};
use world::{Odometry, Point, Pose, Station, Vector, geometry::wrap_angle_rad};

/// The share of effective guesses below which there are too few to continue with.
const TOO_FEW: f64 = 0.02;
/// The scatter of the copies of a survivor, as a share of the spread of all survivors.
const JITTER: f64 = 0.25;
/// The number of attempts to place a new guess within the bounds.
const TRIES: u32 = 20;
/// The largest plausible motion in one tick, metres or radians; larger odometry is refused.
const MOTION_LIMIT: f64 = 1e3;

/// The configuration of a particle filter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ParticlesConfig {
    /// The number of guesses; 2000 are usual.
    pub count: usize,
    /// Largest error of a single range as a share of the distance.
    pub ratio: f64,
    /// The errors of odometry.
    pub odometry: MotionNoise,
    /// Probability that the tracks spin in a motion, 0 to 1.
    pub slip_chance: f64,
    /// The seed for all random numbers.
    pub seed: u64,
}

/// A particle filter with the likelihood of bounded ranges: a guess outside any station's bounds is dropped.
///
/// Where the noise is uniform, the filter is better than any fix from a single cycle, because it remembers earlier
/// cycles. Equal seeds give equal estimates on every machine.
#[derive(Debug, Clone)]
pub struct Particles {
    config: ParticlesConfig,
    guesses: Vec<Guess>,
    rng: Pcg64,
}

#[derive(Debug, Clone, Copy)]
struct Guess {
    pose: Pose,
    slip: f64,
    turn_bias_rad: f64,
    weight: f64,
}

impl Particles {
    /// Creates guesses around a start with the given standard deviations, metres and radians.
    pub fn new(start: Pose, sigma_m: f64, heading_sigma_rad: f64, config: ParticlesConfig) -> Self {
        let mut rng = Pcg64::seed_from_u64(config.seed);
        let count = config.count.clamp(1, 1_000_000);
        let mut normal = |sigma: f64| bounded(sigma) * bell(&mut rng);
        let guesses = (0..count)
            .map(|_| Guess {
                pose: Pose {
                    position: start.position + Vector::new(normal(sigma_m), normal(sigma_m)),
                    heading_rad: start.heading_rad + normal(heading_sigma_rad),
                },
                slip: normal(config.odometry.sigma_per_m).clamp(-0.5, 0.9),
                turn_bias_rad: normal(config.odometry.heading_sigma_per_tick_rad),
                weight: 1.0,
            })
            .collect();
        Self { config, guesses, rng }
    }

    /// Returns the mean pose with the covariance of x, y (square metres) and heading (square radians).
    pub fn estimate(&self) -> (Pose, Matrix3<f64>) {
        let mass: f64 = self.guesses.iter().map(|g| g.weight).sum();
        let share = |g: &Guess| g.weight / mass;
        let position = self.guesses.iter().map(|g| g.pose.position.coords * share(g)).sum::<Vector>();
        let turn = |part: fn(f64) -> f64| {
            self.guesses.iter().map(|g| part(g.pose.heading_rad) * share(g)).sum::<f64>()
        };
        let heading_rad = turn(f64::sin).atan2(turn(f64::cos));
        let pose = Pose { position: Point::from(position), heading_rad };
        let covariance = self.guesses.iter().map(|g| {
            let off = g.pose.position - pose.position;
            let away = nalgebra::Vector3::new(off.x, off.y, wrap_angle_rad(g.pose.heading_rad - heading_rad));
            away * away.transpose() * share(g)
        });
        (pose, covariance.sum())
    }

    /// Moves every guess according to the odometry, each with errors of its own.
    pub fn predict(&mut self, odometry: &Odometry) {
        let Odometry { forward_m, sideways_m, turn_rad } = *odometry;
        if ![forward_m, sideways_m, turn_rad].iter().all(|m| m.abs() <= MOTION_LIMIT) {
            return;
        }
        let (noise, rng) = (self.config.odometry, &mut self.rng);
        let way_m = forward_m.hypot(sideways_m);
        for guess in &mut self.guesses {
            let slips_through = rng.random::<f64>() < self.config.slip_chance;
            let kept = if slips_through { rng.random::<f64>() } else { 1.0 };
            let fresh = bounded(noise.way_sigma_ratio).max(0.3 * bounded(noise.sigma_per_m)) * way_m;
            let along = (1.0 - guess.slip) * kept;
            let turned = turn_rad - guess.turn_bias_rad
                + bounded(noise.turn_sigma_ratio) * turn_rad * bell(rng)
                + bounded(noise.heading_sigma_per_tick_rad) * bell(rng);
            guess.pose = guess.pose.moved(forward_m * along + fresh * bell(rng), sideways_m * along, turned);
        }
    }

    /// Drops every guess that does not explain the ranges. Call [`Self::renew`] to replace the dropped guesses.
    ///
    /// If hardly any guess survives, for example after the tracks spun, all guesses are placed again, according to the
    /// ranges alone.
    ///
    /// # Errors
    /// See [`FixError`]; the guesses are then unchanged.
    pub fn update(&mut self, ranges: &[Ranging], stations: &[Station]) -> Result<(), FixError> {
        let solver = Bounded { ratio: self.config.ratio };
        let prior = self.estimate();
        let prior = (prior.0.position, prior.1.fixed_view::<2, 2>(0, 0).into_owned());
        let bounds = solver.likelihood(ranges, stations)?;
        let weights: Vec<f64> = self.guesses.iter().map(|g| g.weight * bounds.at(g.pose.position)).collect();
        let left = effective(&weights);
        if left < TOO_FEW * self.guesses.len() as f64 {
            let fix = solver.solve(ranges, stations, Some(prior))?;
            self.reinitialise(fix.position, &fix.covariance, |at| bounds.at(at));
        } else {
            self.guesses.iter_mut().zip(&weights).for_each(|(guess, weight)| guess.weight = *weight);
        }
        Ok(())
    }

    /// Replaces weighted guesses by equally weighted ones: likely guesses are copied, and each copy is moved slightly
    /// within the bounds.
    ///
    /// Call this after the estimate of the step has been read.
    pub fn renew(&mut self, ranges: &[Ranging], stations: &[Station]) {
        let weights: Vec<f64> = self.guesses.iter().map(|g| g.weight).collect();
        let n = self.guesses.len();
        if effective(&weights) > 0.5 * n as f64 {
            return;
        }
        let Ok(bounds) = (Bounded { ratio: self.config.ratio }).likelihood(ranges, stations) else { return };
        let spread = self.spread();
        let mass: f64 = weights.iter().sum();
        // Systematic resampling: one random number, evenly spaced picks.
        let step = mass / n as f64;
        let mut pick = self.rng.random::<f64>() * step;
        let (mut reached, mut at) = (weights[0], 0);
        let mut chosen = Vec::with_capacity(n);
        for _ in 0..n {
            while reached < pick && at + 1 < n {
                at += 1;
                reached += weights[at];
            }
            chosen.push(Guess { weight: 1.0, ..self.guesses[at] });
            pick += step;
        }
        for guess in &mut chosen {
            jitter(guess, &spread, &mut self.rng, |place| bounds.at(place) > 0.0);
        }
        self.guesses = chosen;
    }

    /// Returns the square root of the position covariance, and the standard deviations of the other values.
    fn spread(&self) -> Spread {
        let mass: f64 = self.guesses.iter().map(|g| g.weight).sum();
        let (pose, covariance) = self.estimate();
        let deviation = |value: fn(&Guess) -> f64| {
            let mean = self.guesses.iter().map(|g| value(g) * g.weight).sum::<f64>() / mass;
            (self.guesses.iter().map(|g| (value(g) - mean).powi(2) * g.weight).sum::<f64>() / mass).sqrt()
        };
        let heading = pose.heading_rad;
        let heading_variance = self
            .guesses
            .iter()
            .map(|g| wrap_angle_rad(g.pose.heading_rad - heading).powi(2) * g.weight)
            .sum::<f64>()
            / mass;
        Spread {
            position: root(&covariance.fixed_view::<2, 2>(0, 0).into_owned()),
            heading_rad: heading_variance.sqrt(),
            slip: deviation(|g| g.slip),
            turn_bias_rad: deviation(|g| g.turn_bias_rad),
        }
    }

    fn reinitialise(&mut self, mean: Point, covariance: &Matrix2<f64>, likelihood: impl Fn(Point) -> f64) {
        let root = root(covariance) * 1.5;
        let rng = &mut self.rng;
        for guess in &mut self.guesses {
            let mut draw = || mean + root * Vector::new(bell(rng), bell(rng));
            let within = (0..TRIES).map(|_| draw()).find(|at| likelihood(*at) > 0.0);
            guess.pose.position = within.unwrap_or(mean);
            guess.weight = 1.0;
        }
    }
}

/// The spread of the guesses.
struct Spread {
    position: Matrix2<f64>,
    heading_rad: f64,
    slip: f64,
    turn_bias_rad: f64,
}

fn jitter(guess: &mut Guess, spread: &Spread, rng: &mut Pcg64, is_within: impl Fn(Point) -> bool) {
    let at = guess.pose.position;
    for _ in 0..TRIES {
        let place = at + spread.position * Vector::new(bell(rng), bell(rng)) * JITTER;
        if is_within(place) {
            guess.pose.position = place;
            break;
        }
    }
    guess.pose.heading_rad += JITTER * spread.heading_rad * bell(rng);
    guess.slip = (guess.slip + JITTER * spread.slip * bell(rng)).clamp(-0.5, 0.9);
    guess.turn_bias_rad += JITTER * spread.turn_bias_rad * bell(rng);
}

/// Returns the number of equally weighted guesses that would contain as much information as these weighted ones.
fn effective(weights: &[f64]) -> f64 {
    let squares: f64 = weights.iter().map(|w| w * w).sum();
    if squares > 0.0 { weights.iter().sum::<f64>().powi(2) / squares } else { 0.0 }
}

/// Returns the Cholesky factor of a covariance, with its diagonal kept above zero.
fn root(covariance: &Matrix2<f64>) -> Matrix2<f64> {
    let a = covariance[(0, 0)].max(1e-12).sqrt();
    let b = covariance[(0, 1)] / a;
    Matrix2::new(a, 0.0, b, (covariance[(1, 1)] - b * b).max(1e-12).sqrt())
}

fn bell(rng: &mut Pcg64) -> f64 {
    StandardNormal.sample(rng)
}

/// Limits a standard deviation so that numbers stay finite; NaN becomes 0.
fn bounded(sigma: f64) -> f64 {
    if sigma.is_nan() { 0.0 } else { sigma.abs().min(MOTION_LIMIT) }
}

#[cfg(test)]
mod tests;
