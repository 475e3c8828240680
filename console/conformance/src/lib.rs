//! What a planner must do whatever it plans, and how it flies in random tanks beside others: for its author.
//!
//! Everything but times is determined by the plugin and a seed. Frame: the tank frame, metres, radians.
#![forbid(unsafe_code)]

mod checks;
mod flown;
mod row;
mod tank;
mod tape;

pub use checks::Check;
pub use row::Row;

use checks::Subject;
use flown::{Flown, fly};
use mission::PlannerInfo;
use planner_host::PluginDirs;
use rayon::prelude::*;
use scenario::Scenario;
use serde::Serialize;
use tank::Task;

/// How a planner was tried.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trial {
    /// Its id.
    pub planner: String,
    /// Seed of the first tank; the others follow.
    pub first_seed: u64,
    /// What it must do.
    pub checks: Vec<Check>,
    /// How it flew, and how the others did in the same tanks.
    pub rows: Vec<Row>,
}

impl Trial {
    /// Tries a planner in `n` tanks, beside these others as far as they fly such missions.
    pub fn of(
        planner: &PlannerInfo,
        others: &[PlannerInfo],
        plugins: &PluginDirs,
        (n, first_seed): (u64, u64),
    ) -> Self {
        let task = if planner.covers { Task::Cover } else { Task::Goto };
        let tanks: Vec<Scenario> = (0..n).map(|i| tank::draw(task, first_seed.wrapping_add(i))).collect();
        let others =
            others.iter().filter(|other| other.id != planner.id && (task == Task::Goto || other.covers));
        let ids: Vec<&str> = std::iter::once(planner).chain(others).map(|info| info.id.as_str()).collect();
        let flights: Vec<(usize, &Scenario)> =
            (0..ids.len()).flat_map(|id| tanks.iter().map(move |tank| (id, tank))).collect();
        let flown: Vec<Flown> = flights.par_iter().map(|(id, tank)| fly(tank, ids[*id], plugins)).collect();
        let mut rows: Vec<Row> =
            ids.iter().zip(flown.chunks(tanks.len().max(1))).map(|(id, flown)| Row::of(id, flown)).collect();
        // Who does not fly such missions at all is no comparison.
        rows.retain(|row| row.planner == planner.id || row.unsupported < row.tanks);
        let subject = Subject {
            planner,
            plugins,
            tank: &tanks[0],
            beside: rows.get(1).map(|row| row.planner.as_str()),
        };
        let checks = checks::all(&subject, &flown[..tanks.len()]);
        Self { planner: planner.id.clone(), first_seed, checks, rows }
    }

    /// Whether every check passed.
    pub fn is_passed(&self) -> bool {
        self.checks.iter().all(|check| check.failure.is_none())
    }

    /// Checks and rows as text.
    pub fn human(&self) -> String {
        let checks = self.checks.iter().map(Check::line);
        let rows = self.rows.iter().map(Row::line);
        let n = self.rows.first().map_or(0, |row| row.tanks);
        let title = format!("\n{} in {n} random tanks from seed {} on:\n", self.planner, self.first_seed);
        checks.chain([title, Row::HEADINGS.to_owned()]).chain(rows).collect()
    }
}
