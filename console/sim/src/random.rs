//! Random numbers: one stream per purpose, all from one seed.

use crate::config::NoiseModel;
use rand::{Rng, RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal, StudentT};
use rand_pcg::Pcg64;

/// Minimum range that is reported, metres.
const SHORTEST_M: f64 = 1e-6;
/// Maximum range that is reported, metres.
const LONGEST_M: f64 = 1e9;
/// Degrees of freedom of the heavy-tailed noise: the smallest whole number for which the variance exists.
const TAIL_FREEDOM: f64 = 3.0;

/// The streams; they are independent of each other.
#[derive(Debug, Clone)]
pub(crate) struct RandomStreams {
    /// Errors of the ranges.
    pub ranging: Pcg64,
    /// Stations that are not heard.
    pub dropout: Pcg64,
    /// Errors of the odometry.
    pub odometry: Pcg64,
    /// Slip of the tracks.
    pub slip: Pcg64,
    /// Disturbances of ranges other than their random error.
    pub disturbance: Pcg64,
    /// Survey errors of the station positions.
    pub survey: Pcg64,
    /// Timing errors of the ranges.
    pub timing: Pcg64,
    /// Errors of the pressure sensor.
    pub pressure: Pcg64,
    /// Errors and lost rays of the scanner.
    pub scanner: Pcg64,
    /// Times of emission, and clocks of the stations.
    pub clocks: Pcg64,
    /// Errors of the pulses that stations exchange.
    pub pulses: Pcg64,
}

impl RandomStreams {
    pub(crate) fn new(seed: u64) -> Self {
        let stream = |purpose: u64| Pcg64::seed_from_u64(mixed(seed ^ mixed(purpose)));
        Self {
            ranging: stream(1),
            dropout: stream(2),
            odometry: stream(3),
            slip: stream(4),
            disturbance: stream(5),
            survey: stream(6),
            timing: stream(7),
            pressure: stream(8),
            scanner: stream(9),
            clocks: stream(10),
            pulses: stream(11),
        }
    }
}

/// Spreads neighbouring numbers over the whole range (the finaliser of `SplitMix64`).
fn mixed(number: u64) -> u64 {
    let number = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let number = (number ^ (number >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let number = (number ^ (number >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    number ^ (number >> 31)
}

/// A normally distributed number with mean 0 and variance 1.
pub(crate) fn normal(rng: &mut impl Rng) -> f64 {
    rng.sample(StandardNormal)
}

impl NoiseModel {
    /// The error of a range as a share of the distance.
    pub(crate) fn error_ratio(&self, rng: &mut impl Rng) -> f64 {
        match *self {
            Self::None => 0.0,
            Self::Uniform { ratio } => ratio * rng.random_range(-1.0..=1.0),
            Self::Gaussian { sigma_ratio } => sigma_ratio * normal(rng),
            Self::Triangular { ratio } => {
                ratio * (rng.random_range(-0.5..=0.5_f64) + rng.random_range(-0.5..=0.5_f64))
            }
            Self::HeavyTailed { sigma_ratio } => {
                let student = StudentT::new(TAIL_FREEDOM).expect("degrees of freedom are positive");
                // The variance of Student's distribution is k / (k - 2).
                sigma_ratio * student.sample(rng) / (TAIL_FREEDOM / (TAIL_FREEDOM - 2.0)).sqrt()
            }
        }
    }
}

/// A distance with its error, metres, limited to the ranges that can be reported; always positive.
pub(crate) fn reported_m(range_m: f64) -> f64 {
    // The result is NaN if the error overflows; in that case, the maximum range is reported.
    if range_m.is_nan() { LONGEST_M } else { range_m.clamp(SHORTEST_M, LONGEST_M) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn bounded_noise_stays_within_its_bounds(
            distance in 0.01..30.0_f64, ratio in 0.0..0.5_f64, seed in any::<u64>(),
        ) {
            let mut rng = Pcg64::seed_from_u64(seed);
            for model in [NoiseModel::Uniform { ratio }, NoiseModel::Triangular { ratio }] {
                for _ in 0..20 {
                    let range = reported_m(distance * (1.0 + model.error_ratio(&mut rng)));
                    prop_assert!((range - distance).abs() <= ratio * distance * (1.0 + 1e-12));
                }
            }
        }
    }

    fn spread(noise: NoiseModel) -> (f64, f64) {
        let mut rng = Pcg64::seed_from_u64(5);
        let errors: Vec<f64> = (0..20_000).map(|_| noise.error_ratio(&mut rng)).collect();
        let mean = errors.iter().sum::<f64>() / 20_000.0;
        (mean, (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / 20_000.0).sqrt())
    }

    #[test]
    fn the_models_scatter_as_they_say() {
        for (noise, sigma) in [
            (NoiseModel::Uniform { ratio: 0.05 }, 0.05 / 3.0_f64.sqrt()),
            (NoiseModel::Gaussian { sigma_ratio: 0.02 }, 0.02),
            (NoiseModel::Triangular { ratio: 0.05 }, 0.05 / 6.0_f64.sqrt()),
        ] {
            let (mean, spread) = spread(noise);
            assert!(mean.abs() < 4.0 * sigma / 20_000.0_f64.sqrt(), "{noise:?}: {mean}");
            assert!((spread / sigma - 1.0).abs() < 0.03, "{noise:?}: {spread}");
        }
        assert_eq!(spread(NoiseModel::None), (0.0, 0.0));
    }

    #[test]
    fn heavy_tails_keep_to_the_middle_and_go_far_out() {
        let (model, mut rng) = (NoiseModel::HeavyTailed { sigma_ratio: 0.03 }, Pcg64::seed_from_u64(8));
        let errors: Vec<f64> = (0..20_000).map(|_| model.error_ratio(&mut rng).abs()).collect();
        let beyond = |limit: f64| errors.iter().filter(|e| **e > limit).count() as f64 / 20_000.0;
        // Half of Student's distribution with 3 degrees of freedom lies within 0.765 of its scale.
        assert!((beyond(0.765 * 0.03 / 3.0_f64.sqrt()) - 0.5).abs() < 0.02);
        assert!(beyond(4.0 * 0.03) > 3e-3);
    }

    #[test]
    fn streams_and_neighbouring_seeds_differ() {
        let (mut a, mut b) = (RandomStreams::new(1), RandomStreams::new(2));
        let mut first: Vec<u64> = [
            &mut a.ranging,
            &mut a.dropout,
            &mut a.odometry,
            &mut a.slip,
            &mut a.disturbance,
            &mut b.ranging,
        ]
        .into_iter()
        .map(RngExt::random)
        .collect();
        first.sort_unstable();
        first.dedup();
        assert_eq!(first.len(), 6);
    }
}
