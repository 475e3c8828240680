//! Models the scatter of single ranges for the estimator.

use crate::fix::Ranging;
use serde::{Deserialize, Serialize};

/// Degrees of freedom of [`RangeNoise::HeavyTailed`].
pub(crate) const TAIL_FREEDOM: f64 = 3.0;

/// The number of harmonics of the rounding error that are summed; the others amount to at most a fortieth of the whole
/// error.
const HARMONICS: u32 = 24;
/// The number of standard deviations that a normal error practically never exceeds.
const NORMAL_EXTREME: f64 = 6.0;
/// The number of standard deviations that only about one [`RangeNoise::HeavyTailed`] error in ten thousand exceeds.
const TAIL_EXTREME: f64 = 30.0;

/// The distribution of the error of a range as a share of the true distance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "model")]
pub enum RangeNoise {
    /// Uniform between `-ratio` and `ratio` (Wang et al. 2023, eq. 13).
    Uniform {
        /// Largest error as a share of the distance.
        ratio: f64,
    },
    /// Triangular between `-ratio` and `ratio`, like the mean of two uniform errors.
    Triangular {
        /// Largest error as a share of the distance.
        ratio: f64,
    },
    /// Normal.
    Gaussian {
        /// Standard deviation as a share of the distance.
        sigma_ratio: f64,
    },
    /// Student's t distribution with 3 degrees of freedom.
    HeavyTailed {
        /// Standard deviation as a share of the distance.
        sigma_ratio: f64,
    },
}

impl RangeNoise {
    /// Standard deviation as a share of the distance.
    pub fn sigma_ratio(&self) -> f64 {
        match *self {
            Self::Uniform { ratio } => ratio / 3.0_f64.sqrt(),
            Self::Triangular { ratio } => ratio / 6.0_f64.sqrt(),
            Self::Gaussian { sigma_ratio } | Self::HeavyTailed { sigma_ratio } => sigma_ratio,
        }
    }

    /// The largest error as a share of the distance, if it is bounded and usable.
    pub fn bound_ratio(&self) -> Option<f64> {
        match *self {
            Self::Uniform { ratio } | Self::Triangular { ratio } => Some(ratio),
            Self::Gaussian { .. } | Self::HeavyTailed { .. } => None,
        }
        .filter(|ratio| (1e-9..1.0).contains(ratio))
    }

    /// The largest error as a share of the distance: the bound, or a limit that errors practically never exceed.
    pub(crate) fn extreme_ratio(&self) -> f64 {
        match *self {
            Self::Uniform { ratio } | Self::Triangular { ratio } => ratio,
            Self::Gaussian { sigma_ratio } => NORMAL_EXTREME * sigma_ratio,
            Self::HeavyTailed { sigma_ratio } => TAIL_EXTREME * sigma_ratio,
        }
        .abs()
    }

    /// Returns the standard deviation of the midrange of `n` errors as a share of the distance.
    pub fn midrange_sigma_ratio(&self, n: f64) -> f64 {
        match *self {
            Self::Uniform { ratio } => ratio * (2.0 / ((n + 1.0) * (n + 2.0))).sqrt(),
            // For many triangular errors, the variance is (1 - pi/4) / n of the squared bound.
            Self::Triangular { ratio } => {
                (ratio * (0.2146 / n).sqrt()).min(self.sigma_ratio() / n.min(2.0).sqrt())
            }
            // For many normal errors, the variance is half that of one extreme.
            Self::Gaussian { sigma_ratio } => {
                sigma_ratio
                    * (1.0 / n.min(2.0).sqrt()).min(std::f64::consts::PI / (24.0 * n.ln().max(0.1)).sqrt())
            }
            // The extremes of a heavy-tailed distribution do not converge.
            Self::HeavyTailed { sigma_ratio } => sigma_ratio,
        }
    }

    /// Returns the density of an error up to a factor, between 0 and 1.
    pub(crate) fn relative_density(&self, error_ratio: f64) -> f64 {
        match *self {
            Self::Uniform { ratio } => f64::from(u8::from(error_ratio.abs() <= ratio)),
            Self::Triangular { ratio } => (1.0 - error_ratio.abs() / ratio).max(0.0),
            Self::Gaussian { sigma_ratio } => (-0.5 * (error_ratio / sigma_ratio).powi(2)).exp(),
            Self::HeavyTailed { sigma_ratio } => {
                // In units of the scale, which is the standard deviation over sqrt(k / (k - 2)).
                let t2 = (error_ratio / sigma_ratio).powi(2) * TAIL_FREEDOM / (TAIL_FREEDOM - 2.0);
                (1.0 + t2 / TAIL_FREEDOM).powf(-f64::midpoint(TAIL_FREEDOM, 1.0))
            }
        }
    }
}

/// Range errors that do not depend on the distance: timing errors.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Timing {
    /// Standard deviation of a single range, metres: the jitter of a time of flight times the speed of sound.
    pub jitter_m: f64,
    /// Ranges are whole multiples of this, metres: a sampling period times the speed of sound; 0 if they are not
    /// rounded.
    pub resolution_m: f64,
}

impl Timing {
    /// Whether there are no timing errors.
    pub fn is_none(&self) -> bool {
        !(self.jitter_m > 0.0 || self.resolution_m > 0.0)
    }

    /// Returns the standard deviation of the mean of `n` ranges due to timing, metres. `share_sigma_m` is the
    /// standard deviation of the other errors of each range.
    ///
    /// Rounding has a variance of a twelfth of the squared step. If the other errors spread the ranges over several
    /// steps, the rounding error is independent in every range; otherwise a part of it repeats (computed by the
    /// Fourier series of the rounding error, averaged over the distance).
    pub fn mean_sigma_m(&self, share_sigma_m: f64, n: f64) -> f64 {
        let step_m = self.resolution_m;
        let mut repeats_m2 = 0.0;
        let rounding_m2 = step_m * step_m / 12.0;
        if step_m > 0.0 {
            let spread = share_sigma_m.hypot(self.jitter_m) / step_m;
            let harmonic = |k: u32| {
                let k = f64::from(k) * std::f64::consts::PI;
                (-(2.0 * k * spread).powi(2)).exp() / (2.0 * k * k)
            };
            repeats_m2 = ((1..=HARMONICS).map(harmonic).sum::<f64>() * step_m * step_m).min(rounding_m2);
        }
        let fresh_m2 = self.jitter_m * self.jitter_m + rounding_m2 - repeats_m2;
        (repeats_m2 + fresh_m2.max(0.0) / n.max(1.0)).sqrt()
    }

    /// Returns the largest timing error of a range, metres.
    pub(crate) fn extreme_m(&self) -> f64 {
        NORMAL_EXTREME * self.jitter_m + self.resolution_m
    }

    /// Adds timing errors to ranges that were aggregated to one per station. `excess_m` is the length by which all
    /// ranges exceed the distances.
    pub fn apply(&self, rangings: &mut [Ranging], noise: &RangeNoise, excess_m: f64) {
        if self.is_none() {
            return;
        }
        for ranging in rangings {
            let single_m = noise.sigma_ratio() * ranging.range_m;
            let spread_m = noise.sigma_ratio() * (ranging.range_m - excess_m).max(0.0);
            let timing_m = self.mean_sigma_m(spread_m, f64::from(ranging.repetitions));
            // A range that is nearly 0 by chance has no distance-dependent error that could be scaled to other
            // distances.
            ranging.sigma_m = ranging.sigma_m.min(single_m).hypot(timing_m);
            ranging.timing_sigma_m = timing_m;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draws::Draws;

    /// Measured standard deviation of the mean of `n` rounded ranges.
    fn measured_m(timing: Timing, share_sigma_m: f64, n: u32) -> f64 {
        let mut draws = Draws::new(0.0, 1, 11);
        let mut squares = 0.0;
        for _ in 0..4_000 {
            let distance_m = 5.0 + draws.even();
            let sum: f64 = (0..n)
                .map(|_| {
                    let spread_m = share_sigma_m.hypot(timing.jitter_m) * draws.bell();
                    ((distance_m + spread_m) / timing.resolution_m).round() * timing.resolution_m
                })
                .sum();
            squares += (sum / f64::from(n) - distance_m).powi(2);
        }
        (squares / 4_000.0).sqrt()
    }

    #[test]
    fn rounding_repeats_as_far_as_nothing_else_spreads_the_ranges() {
        for (jitter_m, share_sigma_m) in [(0.0, 0.0), (0.01, 0.0), (0.05, 0.02), (0.0, 0.1), (0.2, 0.1)] {
            let timing = Timing { jitter_m, resolution_m: 0.3 };
            for n in [1, 4, 20] {
                let share_m = share_sigma_m / f64::from(n).sqrt();
                let said_m = timing.mean_sigma_m(share_sigma_m, f64::from(n)).hypot(share_m);
                let found_m = measured_m(timing, share_sigma_m, n);
                assert!(
                    (said_m / found_m - 1.0).abs() < 0.06,
                    "{jitter_m} {share_sigma_m} {n}: {said_m} {found_m}"
                );
            }
        }
    }
}
