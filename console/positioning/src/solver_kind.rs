//! The choice of the solver that turns ranges into fixes.

use crate::{
    bounded::Bounded,
    consensus::Consensus,
    differences::Differences,
    fix::{Fix, FixError, Integrity, PositionSolver, Prior, Ranging},
    linear::LinearLs,
    noise::RangeNoise,
    nonlinear::Nls,
    screened::Screened,
    weighted::WeightedLinear,
};
use serde::{Deserialize, Serialize};
use world::Station;

/// The solver that turns ranges into fixes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SolverKind {
    /// [`LinearLs`].
    Linear,
    /// [`WeightedLinear`].
    WeightedLinear,
    /// [`Nls`].
    #[default]
    Nls,
    /// [`Bounded`] with the bound of the noise; [`Nls`] if the noise has no bound. If no position meets the bound,
    /// [`Nls`] is used and its fix becomes suspect.
    Bounded,
    /// [`Consensus`], for cycles in which some ranges are too long.
    Consensus,
    /// [`Differences`]: all ranges in a cycle are too long by the same unknown length.
    Differences,
}

impl SolverKind {
    /// Turns ranges into a fix; a single station that contradicts all others is left out.
    ///
    /// # Errors
    /// See [`FixError`].
    pub fn solve(
        self,
        ranges: &[Ranging],
        stations: &[Station],
        noise: &RangeNoise,
        prior: Option<Prior>,
    ) -> Result<Fix, FixError> {
        match (self, noise.bound_ratio()) {
            (Self::Linear, _) => Screened(LinearLs).solve(ranges, stations, prior),
            (Self::WeightedLinear, _) => Screened(WeightedLinear).solve(ranges, stations, prior),
            (Self::Consensus, _) => Consensus::default().solve(ranges, stations, prior),
            (Self::Differences, _) => Screened(Differences).solve(ranges, stations, prior),
            (Self::Bounded, Some(ratio)) => {
                Bounded { ratio }.solve(ranges, stations, prior).or_else(|error| match error {
                    FixError::EmptySet { .. } => doubted(Screened(Nls).solve(ranges, stations, prior)),
                    other => Err(other),
                })
            }
            (Self::Nls | Self::Bounded, _) => Screened(Nls).solve(ranges, stations, prior),
        }
    }
}

fn doubted(fix: Result<Fix, FixError>) -> Result<Fix, FixError> {
    fix.map(|fix| Fix { integrity: fix.integrity.min_trust(Integrity::Suspect), ..fix })
}
