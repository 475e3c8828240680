//! The repeated ranges of one station brought down to one.

use crate::{
    fix::{FixError, Ranging},
    noise::RangeNoise,
};
use serde::{Deserialize, Serialize};
use world::RangeSet;

/// No aggregated range is trusted more than this, metres: stations are not surveyed any better.
pub const SIGMA_FLOOR_M: f64 = 1e-3;

/// Shortest range that is taken for one, metres.
const SHORTEST_M: f64 = 1e-6;
/// Longest range that is taken for one, metres.
pub(crate) const RANGE_LIMIT_M: f64 = 1e6;

/// Nodes of the numerical posterior of one distance.
const NODES: u32 = 48;
/// Ranges this many sigmas from the median are trimmed.
const TRIM_SIGMAS: f64 = 3.0;
/// Standard deviation of a normal distribution per median absolute deviation.
const SIGMA_PER_MAD: f64 = 1.4826;

/// How repetitions become one range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Aggregation {
    /// The mean of the ranges.
    #[default]
    Mean,
    /// The root of the mean square.
    ///
    /// The linear solution is linear in the squared ranges, so this gives exactly the mean of the positions of the
    /// single repetitions, which is what Wang et al. 2023 average.
    RootMeanSquare,
    /// Half way between the shortest and the longest range: far better than the mean if the noise really is uniform,
    /// worse than it otherwise.
    Midrange,
    /// The mean of the ranges within three sigmas of the median: for pings that are off now and then.
    TrimmedMean,
    /// The mean of the distance given the ranges and their distribution; falls back to [`Self::TrimmedMean`] if no
    /// distance explains all ranges.
    Posterior,
}

impl Aggregation {
    /// One range per station that was heard, in the order given; stations without a single range are left out.
    ///
    /// `noise` is how single ranges scatter; repetitions count as independent.
    ///
    /// # Errors
    /// [`FixError::BadRange`] if a range is no number between a micrometre and a million metres.
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
        // `max` also turns what is no number into the floor.
        let at_least_m = sigma_m.max(SIGMA_FLOOR_M);
        let sigma_m = at_least_m.min(RANGE_LIMIT_M);
        Ok(Ranging { station: set.station, range_m, sigma_m, repetitions, least_m, most_m })
    }
}

/// Mean of the ranges near the median, and how many they are.
///
/// The gate is that of the declared scatter, or wider if most ranges scatter more than declared.
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

/// Mean and standard deviation of a distance, flat beforehand, after ranges with `p(r | l) = f(r / l - 1) / l`; `None`
/// if no distance explains all of them.
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
        // The powers of the distance are taken relative to the upper end, so that they neither vanish nor overflow.
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

/// Whether a number can be a range.
pub(crate) fn is_usable(range_m: f64) -> bool {
    (SHORTEST_M..=RANGE_LIMIT_M).contains(&range_m)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::draws::Draws;
    use proptest::prelude::*;
    use world::StationId;

    const NORMAL: RangeNoise = RangeNoise::Gaussian { sigma_ratio: 0.03 };
    const EVERY: [Aggregation; 5] = [
        Aggregation::Mean,
        Aggregation::RootMeanSquare,
        Aggregation::Midrange,
        Aggregation::TrimmedMean,
        Aggregation::Posterior,
    ];

    fn set(ranges_m: &[f64]) -> RangeSet {
        RangeSet { station: StationId(1), ranges_m: ranges_m.to_vec() }
    }

    #[test]
    fn twenty_repetitions_cut_the_sigma_by_their_root() {
        let ranging = Aggregation::Mean.aggregate(&[set(&[10.0; 20])], &NORMAL).unwrap()[0];
        assert!((ranging.range_m - 10.0).abs() < 1e-12);
        assert!((ranging.sigma_m - 0.3 / 20.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(ranging.repetitions, 20);
    }

    #[test]
    fn the_root_mean_square_keeps_the_mean_of_the_squares() {
        let ranging = Aggregation::RootMeanSquare.aggregate(&[set(&[1.0, 7.0])], &NORMAL).unwrap()[0];
        assert!((ranging.range_m - 5.0).abs() < 1e-12);
    }

    #[test]
    fn a_station_without_ranges_is_silent() {
        assert!(Aggregation::Mean.aggregate(&[set(&[])], &NORMAL).unwrap().is_empty());
    }

    #[test]
    fn one_bad_repetition_is_an_error() {
        for bad in [0.0, -1.0, 1e-300, f64::NAN, f64::INFINITY, 1e300] {
            let answer = Aggregation::Mean.aggregate(&[set(&[5.0, bad])], &NORMAL);
            assert_eq!(answer, Err(FixError::BadRange { station: StationId(1) }), "{bad}");
        }
    }

    #[test]
    fn exact_ranges_still_have_a_sigma() {
        let ranging = Aggregation::Mean
            .aggregate(&[set(&[5.0])], &RangeNoise::Gaussian { sigma_ratio: 0.0 })
            .unwrap()[0];
        assert!((ranging.sigma_m - SIGMA_FLOOR_M).abs() < 1e-15);
    }

    /// Root mean square error and sigma of 20 uniform or triangular errors of at most 5 % at 10 m.
    fn scatter(how: Aggregation, noise: &RangeNoise) -> (f64, f64) {
        let mut draws = Draws::new(0.05, 20, 9);
        let error = |draws: &mut Draws| match noise {
            RangeNoise::Triangular { .. } => f64::midpoint(draws.even(), draws.even()),
            _ => draws.even(),
        };
        let (mut squares, mut sigmas) = (0.0, 0.0);
        for _ in 0..4_000 {
            let ranges: Vec<f64> = (0..20).map(|_| 10.0 * (1.0 + 0.05 * error(&mut draws))).collect();
            let ranging = how.aggregate(&[set(&ranges)], noise).unwrap()[0];
            squares += (ranging.range_m - 10.0).powi(2);
            sigmas += ranging.sigma_m.powi(2);
        }
        ((squares / 4_000.0_f64).sqrt(), (sigmas / 4_000.0_f64).sqrt())
    }

    #[test]
    fn every_way_knows_its_own_scatter() {
        for noise in [RangeNoise::Uniform { ratio: 0.05 }, RangeNoise::Triangular { ratio: 0.05 }] {
            for how in EVERY {
                let (error, sigma) = scatter(how, &noise);
                assert!((sigma / error - 1.0).abs() < 0.08, "{how:?} {noise:?}: {sigma} for {error}");
            }
        }
    }

    #[test]
    fn the_extremes_are_more_informative_than_the_mean_for_bounded_noise() {
        let uniform = RangeNoise::Uniform { ratio: 0.05 };
        let (mean, _) = scatter(Aggregation::Mean, &uniform);
        assert!(scatter(Aggregation::Midrange, &uniform).0 < 0.55 * mean);
        assert!(scatter(Aggregation::Posterior, &uniform).0 < 0.55 * mean);
        let triangular = RangeNoise::Triangular { ratio: 0.05 };
        let (mean, _) = scatter(Aggregation::Mean, &triangular);
        assert!(scatter(Aggregation::Midrange, &triangular).0 > 1.05 * mean);
        assert!(scatter(Aggregation::Posterior, &triangular).0 < 0.95 * mean);
    }

    #[test]
    fn a_wild_ping_is_trimmed() {
        let mut ranges = vec![10.0, 10.1, 9.9, 10.2, 9.8, 10.0, 10.05, 9.95];
        let clean = Aggregation::TrimmedMean.aggregate(&[set(&ranges)], &NORMAL).unwrap()[0];
        ranges.push(14.0);
        let trimmed = Aggregation::TrimmedMean.aggregate(&[set(&ranges)], &NORMAL).unwrap()[0];
        assert!((trimmed.range_m - clean.range_m).abs() < 1e-12);
        assert!((trimmed.sigma_m - clean.sigma_m).abs() < 1e-12);
        assert!((trimmed.most_m - 14.0).abs() < 1e-12, "the extremes are those of all pings");
    }

    #[test]
    fn ranges_that_no_distance_explains_fall_back_to_the_trimmed_mean() {
        let far_apart = [set(&[9.0, 10.0, 11.0])];
        let noise = RangeNoise::Uniform { ratio: 0.05 };
        let posterior = Aggregation::Posterior.aggregate(&far_apart, &noise).unwrap();
        assert_eq!(posterior, Aggregation::TrimmedMean.aggregate(&far_apart, &noise).unwrap());
    }

    proptest! {
        #[test]
        fn every_way_stays_between_the_extremes(
            ranges in prop::collection::vec(0.01..100.0_f64, 1..30), ratio in 1e-6..0.9_f64,
        ) {
            let least = ranges.iter().copied().fold(f64::INFINITY, f64::min);
            let most = ranges.iter().copied().fold(0.0, f64::max);
            for noise in [RangeNoise::Gaussian { sigma_ratio: ratio }, RangeNoise::HeavyTailed { sigma_ratio: ratio }] {
                for how in [Aggregation::Mean, Aggregation::RootMeanSquare, Aggregation::Midrange, Aggregation::TrimmedMean] {
                    let ranging = how.aggregate(&[set(&ranges)], &noise).unwrap()[0];
                    prop_assert!(ranging.range_m >= least * 0.999_999 && ranging.range_m <= most * 1.000_001);
                    prop_assert!(ranging.sigma_m.is_finite());
                }
            }
        }
    }
}
