//! A robot that drives along the spiral and slips.

use super::setup::{rng, spiral};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use world::{Odometry, Point, Pose, geometry::wrap_angle_rad};

/// Scatter of the measured length of a step, as a share of the length.
const WAY_SIGMA: f64 = 0.05;
/// Probability of a strong slip of the tracks in a step.
pub(super) const SLIP_CHANCE: f64 = 0.02;
/// Scatter of the measured turn of a step, radians.
const TURN_SIGMA_RAD: f64 = 0.01;
/// Standard deviation of the gyro's bias, radians per step.
const BIAS_SIGMA_RAD: f64 = 0.001;

/// A run along the spiral: the true places, and the odometry of the steps between them.
pub(super) struct Track {
    /// The first pose is known.
    pub start: Pose,
    /// For each step, the measured motion and the true pose at its end.
    pub steps: Vec<(Odometry, Point)>,
}

/// The spiral driven with 1 to 5 % slip throughout, 5 % scatter, some steps with 30 to 70 % slip, and a gyro with a
/// bias.
pub(super) fn track(seed: u64) -> Track {
    let mut rng = rng(seed, 7);
    let truths = spiral();
    let slip = rng.random_range(0.01..0.05);
    let normal = |rng: &mut rand_pcg::Pcg64| -> f64 { StandardNormal.sample(rng) };
    let bias = BIAS_SIGMA_RAD * normal(&mut rng);
    let heading = |from: Point, to: Point| (to.y - from.y).atan2(to.x - from.x);
    let start = Pose { position: truths[0], heading_rad: heading(truths[0], truths[1]) };
    let mut pose = start;
    let mut steps = Vec::with_capacity(truths.len() - 1);
    for (k, to) in truths.iter().enumerate().skip(1) {
        let next_heading = truths.get(k + 1).map_or(pose.heading_rad, |next| heading(*to, *next));
        let way = to - pose.position;
        // Half of the turn comes before the straight step: the robot drives an arc.
        let along = pose.heading_rad + wrap_angle_rad(next_heading - pose.heading_rad) / 2.0;
        let forward = way.x * along.cos() + way.y * along.sin();
        let sideways = -way.x * along.sin() + way.y * along.cos();
        let lost = if rng.random::<f64>() < SLIP_CHANCE { rng.random_range(0.3..0.7) } else { 0.0 };
        let scale = (1.0 + WAY_SIGMA * normal(&mut rng)) / ((1.0 - slip) * (1.0 - lost));
        let odometry = Odometry {
            forward_m: forward * scale,
            sideways_m: sideways * scale,
            turn_rad: wrap_angle_rad(next_heading - pose.heading_rad)
                + bias
                + TURN_SIGMA_RAD * normal(&mut rng),
        };
        steps.push((odometry, *to));
        pose = Pose { position: *to, heading_rad: next_heading };
    }
    Track { start, steps }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dead_reckoning_ends_metres_off() {
        let mean = |seed: u64| {
            let track = track(seed);
            let mut pose = track.start;
            let errors = track.steps.iter().map(|(odometry, truth)| {
                pose = pose.moved(odometry.forward_m, odometry.sideways_m, odometry.turn_rad);
                (pose.position - truth).norm()
            });
            errors.sum::<f64>() / track.steps.len() as f64
        };
        let all = (0..30).map(mean).sum::<f64>() / 30.0;
        assert!((1.5..3.5).contains(&all), "{all}");
    }
}
