//! Combines the repeated ranges of one station into one.

use crate::{
    fix::{FixError, Ranging},
    noise::RangeNoise,
};
use serde::{Deserialize, Serialize};
use world::RangeSet;

/// The least standard deviation of an aggregated range, metres: stations are not surveyed more accurately than this.
pub const SIGMA_FLOOR_M: f64 = 1e-3;

/// The shortest valid range, metres.
const SHORTEST_M: f64 = 1e-6;
/// The longest valid range, metres.
pub(crate) const RANGE_LIMIT_M: f64 = 1e6;

/// The number of nodes in the numerical posterior of one distance.
const NODES: u32 = 48;
/// Number of sigmas from the median beyond which ranges are trimmed.
const TRIM_SIGMAS: f64 = 3.0;
/// Standard deviation of a normal distribution, as a multiple of its median absolute deviation.
const SIGMA_PER_MAD: f64 = 1.4826;

/// The method that combines repetitions into one range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Aggregation {
    /// The mean of the ranges.
    #[default]
    Mean,
    /// The root mean square of the ranges.
    ///
    /// The linear solution is linear in the squared ranges. This method therefore gives exactly the mean of the
    /// positions computed from the single repetitions, as in Wang et al. 2023.
    RootMeanSquare,
    /// The midpoint between the shortest and the longest range: far better than the mean if the noise really is
    /// uniform, and worse for any other noise.
    Midrange,
    /// The mean of the ranges within three sigmas of the median, for occasional outliers.
    TrimmedMean,
    /// The posterior mean of the distance, given the ranges and their distribution; falls back to
    /// [`Self::TrimmedMean`] if no distance is consistent with all ranges.
    Posterior,
}

impl Aggregation {
    /// Returns one range per station heard, in the order of `sets`; stations without ranges are left out.
    ///
    /// `noise` is the scatter of single ranges; repetitions are assumed to be independent.
    ///
    /// # Errors
    /// [`FixError::BadRange`] if a range is not between a micrometre and a million metres, or is not a number.
    pub fn aggregate(self, sets: &[RangeSet], noise: &RangeNoise) -> Result<Vec<Ranging>, FixError> {
        sets.iter().filter(|set| !set.ranges_m.is_empty()).map(|set| self.one(set, noise)).collect()
    }

    fn one(self, set: &RangeSet, noise: &RangeNoise) -> Result<Ranging, FixError> {
        let ranges_m = &set.ranges_m;
        if !ranges_m.iter().copied().all(is_usable) {
            return Err(FixError::BadRange { station: set.station });
        }
        let extremes = |(low, high): (f64, f64), r: &f64| (low.min(*r), high.max(*r));
        let (least_m, most_m) = ranges_m.iter().fold((f64::INFINITY, 0.0), extremes);
        let n = ranges_m.len() as f64;
        let of_mean = |range_m: f64, n: f64| (range_m, noise.sigma_ratio() * range_m / n.sqrt());
        let (range_m, sigma_m) = match self {
            Self::Mean => of_mean(ranges_m.iter().sum::<f64>() / n, n),
            Self::RootMeanSquare => of_mean((ranges_m.iter().map(|r| r * r).sum::<f64>() / n).sqrt(), n),
            Self::Midrange => {
                let middle = f64::midpoint(least_m, most_m);
                (middle, noise.midrange_sigma_ratio(n) * middle)
            }
            Self::TrimmedMean => {
                let (range_m, kept) = trimmed_mean(ranges_m, noise.sigma_ratio());
                of_mean(range_m, kept)
            }
            Self::Posterior => posterior(ranges_m, (least_m, most_m), noise).unwrap_or_else(|| {
                let (range_m, kept) = trimmed_mean(ranges_m, noise.sigma_ratio());
                of_mean(range_m, kept)
            }),
        };
        let repetitions = u32::try_from(ranges_m.len()).unwrap_or(u32::MAX);
        // `max` also replaces NaN with the lower limit.
        let at_least_m = sigma_m.max(SIGMA_FLOOR_M);
        let sigma_m = at_least_m.min(RANGE_LIMIT_M);
        let station = set.station;
        Ok(Ranging { station, range_m, sigma_m, repetitions, least_m, most_m, timing_sigma_m: 0.0 })
    }
}

/// Returns the mean of the ranges near the median, and their number.
///
/// The gate follows the declared scatter; it is wider if most ranges scatter more than declared.
fn trimmed_mean(ranges_m: &[f64], sigma_ratio: f64) -> (f64, f64) {
    let middle = median(ranges_m.to_vec());
    let mad = median(ranges_m.iter().map(|r| (r - middle).abs()).collect());
    let gate_m = TRIM_SIGMAS * (SIGMA_PER_MAD * mad).max(sigma_ratio * middle).max(SIGMA_FLOOR_M);
    let near = || ranges_m.iter().filter(|r| (*r - middle).abs() <= gate_m);
    let n = near().count().max(1) as f64;
    (if near().next().is_some() { near().sum::<f64>() / n } else { middle }, n)
}

fn median(mut numbers: Vec<f64>) -> f64 {
    let half = numbers.len() / 2;
    let is_even = numbers.len().is_multiple_of(2);
    let (below, middle, _) = numbers.select_nth_unstable_by(half, f64::total_cmp);
    let middle = *middle;
    if is_even { f64::midpoint(below.iter().copied().fold(0.0, f64::max), middle) } else { middle }
}

/// Returns the posterior mean and standard deviation of a distance with a flat prior, given ranges with the density
/// `p(r | l) = f(r / l - 1) / l`; `None` if no distance is consistent with all of them.
fn posterior(ranges_m: &[f64], (least_m, most_m): (f64, f64), noise: &RangeNoise) -> Option<(f64, f64)> {
    let n = ranges_m.len() as f64;
    let (low, high) = match (noise, noise.bound_ratio()) {
        (_, Some(ratio)) => (most_m / (1.0 + ratio), least_m / (1.0 - ratio)),
        (RangeNoise::HeavyTailed { sigma_ratio }, None) => {
            let middle = median(ranges_m.to_vec());
            let reach = 4.0 * sigma_ratio * middle / n.sqrt();
            ((middle - reach).max(SHORTEST_M), middle + reach)
        }
        _ => {
            let mean = ranges_m.iter().sum::<f64>() / n;
            return Some((mean, noise.sigma_ratio() * mean / n.sqrt()));
        }
    };
    if low >= high {
        return None;
    }
    let width = (high - low) / f64::from(NODES);
    let weight = |l: f64| {
        // The powers of the distance are relative to the upper end, so that they neither underflow nor overflow.
        let shrink = high / l;
        if matches!(noise, RangeNoise::Uniform { .. }) {
            return shrink.powi(ranges_m.len() as i32);
        }
        ranges_m.iter().map(|r| shrink * noise.relative_density(r / l - 1.0)).product::<f64>()
    };
    let node = |k: u32| low + (f64::from(k) + 0.5) * width;
    let (mut mass, mut first, mut second) = (0.0, 0.0, 0.0);
    for (offset, weight) in (0..NODES).map(node).map(|l| (l - low, weight(l))) {
        mass += weight;
        first += weight * offset;
        second += weight * offset * offset;
    }
    let mean = first / mass;
    let variance = second / mass - mean * mean + width * width / 12.0;
    let sound = mass > 0.0 && mean.is_finite() && variance.is_finite();
    sound.then(|| (low + mean, variance.max(0.0).sqrt()))
}

/// Whether a number is a valid range.
pub(crate) fn is_usable(range_m: f64) -> bool {
    (SHORTEST_M..=RANGE_LIMIT_M).contains(&range_m)
}

#[cfg(test)]
mod tests;
