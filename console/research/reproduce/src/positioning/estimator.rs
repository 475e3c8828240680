//! The estimators that are compared: from ranges to a fix.

use super::{
    outcome::Outcome,
    setup::{Cycle, Setup},
};
use positioning::{
    Aggregation, Bounded, Consensus, Fix, FixError, LinearLs, Nls, PositionSolver, RangeNoise, Ranging,
    Screened, WeightedLinear,
};
use std::time::Instant;
use world::{RangeSet, Station};

type Solve = fn(&[Ranging], &[Station], &RangeNoise) -> Result<Fix, FixError>;

/// An aggregator with a solver.
#[derive(Clone, Copy)]
pub(super) struct Estimator {
    /// Id of the rows.
    pub id: &'static str,
    aggregation: Aggregation,
    solve: Solve,
}

impl Estimator {
    /// The fix of one cycle.
    pub(super) fn fix(&self, setup: &Setup, sets: &[RangeSet]) -> Result<Fix, FixError> {
        let noise = setup.noise();
        (self.solve)(&self.ranges(sets, &noise)?, &setup.stations, &noise)
    }

    /// Compares the fixes of some cycles with the truth.
    pub(super) fn outcomes(&self, setup: &Setup, cycles: &[Cycle]) -> Vec<Outcome> {
        let outcome = |cycle: &Cycle| {
            let began = Instant::now();
            let fix = self.fix(setup, &cycle.sets);
            Outcome::of(&fix, cycle.truth, began.elapsed().as_secs_f64() * 1e6)
        };
        cycles.iter().map(outcome).collect()
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
pub(super) const LINEAR: Estimator = Estimator {
    id: "linear",
    aggregation: Aggregation::RootMeanSquare,
    solve: |ranges, stations, _| LinearLs.solve(ranges, stations, None),
};
/// Weighted linear least squares on the means.
pub(super) const WEIGHTED: Estimator = Estimator {
    id: "weighted-linear",
    aggregation: Aggregation::Mean,
    solve: |ranges, stations, _| WeightedLinear.solve(ranges, stations, None),
};
/// Nonlinear least squares on the means.
pub(super) const NLS: Estimator = Estimator { id: "nls", aggregation: Aggregation::Mean, solve: nls };
/// Nonlinear least squares on the midranges.
pub(super) const NLS_MIDRANGE: Estimator =
    Estimator { id: "nls/midrange", aggregation: Aggregation::Midrange, solve: nls };
/// Nonlinear least squares on the posterior means.
pub(super) const NLS_POSTERIOR: Estimator =
    Estimator { id: "nls/posterior", aggregation: Aggregation::Posterior, solve: nls };
/// Nonlinear least squares on the trimmed means.
pub(super) const NLS_TRIMMED: Estimator =
    Estimator { id: "nls/trimmed", aggregation: Aggregation::TrimmedMean, solve: nls };
/// Nonlinear least squares, leaving out one station that contradicts all others.
pub(super) const NLS_SCREENED: Estimator = Estimator {
    id: "nls/screened",
    aggregation: Aggregation::TrimmedMean,
    solve: |ranges, stations, _| Screened(Nls).solve(ranges, stations, None),
};
/// The set of positions within all bounds.
pub(super) const BOUNDED: Estimator =
    Estimator { id: "bounded", aggregation: Aggregation::Mean, solve: bounded };
/// The set of positions within all bounds, or nonlinear least squares if the set is empty.
pub(super) const BOUNDED_OR_NLS: Estimator = Estimator {
    id: "bounded/or-nls",
    aggregation: Aggregation::TrimmedMean,
    solve: |ranges, stations, noise| {
        bounded(ranges, stations, noise).or_else(|_| nls(ranges, stations, noise))
    },
};
/// The position on which most stations agree.
pub(super) const CONSENSUS: Estimator = Estimator {
    id: "consensus",
    aggregation: Aggregation::TrimmedMean,
    solve: |ranges, stations, _| Consensus::default().solve(ranges, stations, None),
};

fn nls(ranges: &[Ranging], stations: &[Station], _: &RangeNoise) -> Result<Fix, FixError> {
    Nls.solve(ranges, stations, None)
}
