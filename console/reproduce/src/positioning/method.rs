//! The ways from ranges to a fix that are compared.

use positioning::{
    Aggregation, Bounded, Consensus, Fix, FixError, LinearLs, Nls, PositionSolver, RangeNoise, Ranging,
    Screened, WeightedLinear,
};
use world::{RangeSet, Station};

type Solve = fn(&[Ranging], &[Station], &RangeNoise) -> Result<Fix, FixError>;

/// An aggregator with a solver.
#[derive(Clone, Copy)]
pub(super) struct Method {
    /// Id of the rows.
    pub id: &'static str,
    aggregation: Aggregation,
    solve: Solve,
}

impl Method {
    /// The fix of one cycle.
    pub(super) fn fix(
        &self,
        sets: &[RangeSet],
        stations: &[Station],
        noise: &RangeNoise,
    ) -> Result<Fix, FixError> {
        (self.solve)(&self.ranges(sets, noise)?, stations, noise)
    }

    /// One range for each station.
    pub(super) fn ranges(&self, sets: &[RangeSet], noise: &RangeNoise) -> Result<Vec<Ranging>, FixError> {
        self.aggregation.aggregate(sets, noise)
    }
}

fn bounded(ranges: &[Ranging], stations: &[Station], noise: &RangeNoise) -> Result<Fix, FixError> {
    let ratio = noise.bound_ratio().ok_or(FixError::EmptySet { ratio: 0.0 })?;
    Bounded { ratio }.solve(ranges, stations, None)
}

/// The paper: the mean of the linear solutions of the single repetitions.
pub(super) const LINEAR: Method = Method {
    id: "linear",
    aggregation: Aggregation::RootMeanSquare,
    solve: |ranges, stations, _| LinearLs.solve(ranges, stations, None),
};
/// Weighted linear least squares on the means.
pub(super) const WEIGHTED: Method = Method {
    id: "weighted-linear",
    aggregation: Aggregation::Mean,
    solve: |ranges, stations, _| WeightedLinear.solve(ranges, stations, None),
};
/// Nonlinear least squares on the means.
pub(super) const NLS: Method = Method { id: "nls", aggregation: Aggregation::Mean, solve: nls };
/// The same on the midranges.
pub(super) const NLS_MIDRANGE: Method =
    Method { id: "nls/midrange", aggregation: Aggregation::Midrange, solve: nls };
/// The same on the posterior means.
pub(super) const NLS_POSTERIOR: Method =
    Method { id: "nls/posterior", aggregation: Aggregation::Posterior, solve: nls };
/// The same on the trimmed means.
pub(super) const NLS_TRIMMED: Method =
    Method { id: "nls/trimmed", aggregation: Aggregation::TrimmedMean, solve: nls };
/// The same, leaving out one station that contradicts all others.
pub(super) const NLS_SCREENED: Method = Method {
    id: "nls/screened",
    aggregation: Aggregation::TrimmedMean,
    solve: |ranges, stations, _| Screened(Nls).solve(ranges, stations, None),
};
/// The positions within all bounds.
pub(super) const BOUNDED: Method = Method { id: "bounded", aggregation: Aggregation::Mean, solve: bounded };
/// The same; nonlinear least squares where no position is left.
pub(super) const BOUNDED_OR_NLS: Method = Method {
    id: "bounded/or-nls",
    aggregation: Aggregation::TrimmedMean,
    solve: |ranges, stations, noise| {
        bounded(ranges, stations, noise).or_else(|_| nls(ranges, stations, noise))
    },
};
/// What most stations agree on.
pub(super) const CONSENSUS: Method = Method {
    id: "consensus",
    aggregation: Aggregation::TrimmedMean,
    solve: |ranges, stations, _| Consensus::default().solve(ranges, stations, None),
};

fn nls(ranges: &[Ranging], stations: &[Station], _: &RangeNoise) -> Result<Fix, FixError> {
    Nls.solve(ranges, stations, None)
}
