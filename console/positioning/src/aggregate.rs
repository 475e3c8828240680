//! The repeated ranges of one station brought down to one.

use crate::fix::{FixError, Ranging};
use serde::{Deserialize, Serialize};
use world::RangeSet;

/// No aggregated range is trusted more than this, metres: stations are not surveyed any better.
pub const SIGMA_FLOOR_M: f64 = 1e-3;

/// Shortest range that is taken for one, metres.
const SHORTEST_M: f64 = 1e-6;
/// Longest range that is taken for one, metres.
pub(crate) const RANGE_LIMIT_M: f64 = 1e6;

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
}

impl Aggregation {
    /// One range per station that was heard, in the order given; stations without a single range are left out.
    ///
    /// `sigma_ratio` is the standard deviation of one range as a share of the range; repetitions count as independent.
    ///
    /// # Errors
    /// [`FixError::BadRange`] if a range is no number between a micrometre and a million metres.
    pub fn aggregate(self, sets: &[RangeSet], sigma_ratio: f64) -> Result<Vec<Ranging>, FixError> {
        sets.iter().filter(|set| !set.ranges_m.is_empty()).map(|set| self.one(set, sigma_ratio)).collect()
    }

    fn one(self, set: &RangeSet, sigma_ratio: f64) -> Result<Ranging, FixError> {
        if !set.ranges_m.iter().copied().all(is_usable) {
            return Err(FixError::BadRange { station: set.station });
        }
        let n = set.ranges_m.len() as f64;
        let range_m = match self {
            Self::Mean => set.ranges_m.iter().sum::<f64>() / n,
            Self::RootMeanSquare => (set.ranges_m.iter().map(|r| r * r).sum::<f64>() / n).sqrt(),
        };
        // `max` also turns what is no number into the floor.
        let at_least_m = (sigma_ratio * range_m / n.sqrt()).max(SIGMA_FLOOR_M);
        let sigma_m = at_least_m.min(RANGE_LIMIT_M);
        let repetitions = u32::try_from(set.ranges_m.len()).unwrap_or(u32::MAX);
        Ok(Ranging { station: set.station, range_m, sigma_m, repetitions })
    }
}

/// Whether a number can be a range.
pub(crate) fn is_usable(range_m: f64) -> bool {
    (SHORTEST_M..=RANGE_LIMIT_M).contains(&range_m)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use world::StationId;

    fn set(ranges_m: &[f64]) -> RangeSet {
        RangeSet { station: StationId(1), ranges_m: ranges_m.to_vec() }
    }

    #[test]
    fn twenty_repetitions_cut_the_sigma_by_their_root() {
        let ranging = Aggregation::Mean.aggregate(&[set(&[10.0; 20])], 0.03).unwrap()[0];
        assert!((ranging.range_m - 10.0).abs() < 1e-12);
        assert!((ranging.sigma_m - 0.3 / 20.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(ranging.repetitions, 20);
    }

    #[test]
    fn the_root_mean_square_keeps_the_mean_of_the_squares() {
        let ranging = Aggregation::RootMeanSquare.aggregate(&[set(&[1.0, 7.0])], 0.03).unwrap()[0];
        assert!((ranging.range_m - 5.0).abs() < 1e-12);
    }

    #[test]
    fn a_station_without_ranges_is_silent() {
        assert!(Aggregation::Mean.aggregate(&[set(&[])], 0.03).unwrap().is_empty());
    }

    #[test]
    fn one_bad_repetition_is_an_error() {
        for bad in [0.0, -1.0, 1e-300, f64::NAN, f64::INFINITY, 1e300] {
            let answer = Aggregation::Mean.aggregate(&[set(&[5.0, bad])], 0.03);
            assert_eq!(answer, Err(FixError::BadRange { station: StationId(1) }), "{bad}");
        }
    }

    #[test]
    fn exact_ranges_still_have_a_sigma() {
        let ranging = Aggregation::Mean.aggregate(&[set(&[5.0])], 0.0).unwrap()[0];
        assert!((ranging.sigma_m - SIGMA_FLOOR_M).abs() < 1e-15);
    }
}
