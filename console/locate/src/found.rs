//! Clock and sound errors found in a session.

use positioning::{Calibration, Ranging};
use world::RangeSet;

/// The common error of all ranges, each part with its standard deviation: `range = distance * (1 + scale) + offset`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Found {
    scale: (f64, f64),
    offset_m: (f64, f64),
}

impl Found {
    /// Creates a correction for ranges that are all too long by the same share.
    pub(crate) fn of_scale(scale: (f64, f64)) -> Self {
        Self { scale, offset_m: (0.0, 0.0) }
    }

    /// The share by which all ranges are too long, and its standard deviation.
    pub fn scale(&self) -> (f64, f64) {
        self.scale
    }

    /// The length by which all ranges are too long, and its standard deviation, metres.
    pub fn offset_m(&self) -> (f64, f64) {
        self.offset_m
    }

    /// Removes the common error from sets of ranges.
    pub(crate) fn correct(&self, sets: &mut [RangeSet]) {
        let by = 1.0 / (1.0 + self.scale.0);
        for range_m in sets.iter_mut().flat_map(|set| &mut set.ranges_m) {
            *range_m = (*range_m - self.offset_m.0) * by;
        }
    }

    /// Removes the common error from single ranges.
    pub(crate) fn corrected(&self, ranges: &mut [Ranging]) {
        let by = 1.0 / (1.0 + self.scale.0);
        for range in ranges {
            range.range_m = (range.range_m - self.offset_m.0) * by;
            range.sigma_m *= by;
            range.timing_sigma_m *= by;
        }
    }
}

impl From<&Calibration> for Found {
    fn from(calibration: &Calibration) -> Self {
        Self { scale: calibration.scale(), offset_m: calibration.offset_m() }
    }
}
