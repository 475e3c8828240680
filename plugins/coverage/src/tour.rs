//! The order of the lanes: a closed tour from home over every lane, in either direction, found by local search.
//!
//! First greedy joining, then 2-opt and Or-opt over neighbour lists, then small kicks that are kept if they help. Any
//! order is safe for the tether; only length and turns depend on it.

mod connectors;
mod costs;
mod greedy;
mod search;

use crate::jobs::Job;
pub(crate) use connectors::Connectors;
pub(crate) use costs::{Costs, Tour};
use planner_api::Result;
pub(crate) use search::Effort;

/// Improves a given tour of a few lanes.
pub(crate) fn tour_from(
    entries: Tour,
    connectors: &Connectors<'_>,
    effort: &Effort,
    job: &Job,
) -> Result<Tour> {
    search::improved(connectors, &greedy::neighbours_of_few(connectors), entries, effort, job)
}

/// Finds a good tour.
pub(crate) fn tour(connectors: &Connectors<'_>, effort: &Effort, job: &Job) -> Result<Tour> {
    let near = greedy::neighbours(connectors, job)?;
    let entries = greedy::greedy(connectors, &near);
    search::improved(connectors, &near, entries, effort, job)
}
