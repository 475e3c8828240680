//! The condition under which a campaign may end before its last seed.

use crate::{
    findings::COMPLETE,
    frozen::Campaign,
    statistics::{Share, Sums},
    table::Table,
};
use serde::{Deserialize, Serialize};

/// A campaign may end when the 95 % interval of a figure is narrow enough for every planner and point.
///
/// The condition is checked after each complete seed, in order, so the end depends neither on the blocks nor on which
/// worker ran which mission when.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Until {
    /// A column of the table, or `success`.
    pub metric: String,
    /// Half width that is sufficient.
    pub below: f64,
    /// Minimum number of seeds.
    pub seeds_min: u64,
}

impl Until {
    /// Default minimum number of seeds: a few values that happen to be equal would give false certainty.
    pub(crate) const SEEDS_MIN: u64 = 10;
}

/// Checks missions, in order, until the condition is met.
pub struct Watch<'a> {
    campaign: &'a Campaign,
    until: &'a Until,
    arms: Vec<(u64, u64, Sums)>,
    taken: u64,
    /// The number of seeds that turned out to be sufficient.
    enough: Option<u64>,
}

impl<'a> Watch<'a> {
    /// Creates a check that has seen no missions yet; `None` for a campaign that runs all its seeds.
    pub fn new(campaign: &'a Campaign) -> Option<Self> {
        let until = campaign.design.until.as_ref()?;
        let arms = vec![(0, 0, Sums::default()); campaign.arms()];
        Some(Self { campaign, until, arms, taken: 0, enough: None })
    }

    /// Adds the next rows; returns the sufficient number of seeds as soon as it is known.
    pub fn take(&mut self, rows: &Table) -> Option<u64> {
        let success = rows.flags("success");
        let values = rows.numbers(&self.until.metric);
        let outcome = rows.words("outcome");
        for (row, success) in success.into_iter().enumerate() {
            if self.enough.is_some() {
                break;
            }
            let (hits, n, sums) = &mut self.arms[self.campaign.arm(self.taken)];
            *n += 1;
            *hits += u64::from(success);
            let is_complete = outcome.get(row).is_some_and(|word| word.as_deref() == Some(COMPLETE));
            if let Some(value) = values.get(row).copied().flatten().filter(|_| is_complete) {
                sums.take(value);
            }
            self.taken += 1;
            let seeds = self.taken / self.campaign.per_seed();
            if self.taken.is_multiple_of(self.campaign.per_seed())
                && seeds >= self.until.seeds_min
                && self.is_narrow()
            {
                self.enough = Some(seeds);
            }
        }
        self.enough
    }

    fn is_narrow(&self) -> bool {
        self.arms.iter().all(|(hits, n, sums)| {
            let half = match self.until.metric.as_str() {
                "success" => Some(Share::of(*hits, *n).half()),
                _ => sums.mean().and_then(|mean| mean.half),
            };
            half.is_some_and(|half| half < self.until.below)
        })
    }
}
