//! Tests a planner for its author: checks what every planner must do, and compares its missions in random tanks with
//! those of other planners.
//!
//! Everything except the times and the memory is determined by the plugin and a seed. Positions are in the tank frame,
//! in metres; angles are in radians.
#![forbid(unsafe_code)]

mod checks;
mod flown;
mod row;
mod tank;
mod tape;

pub use checks::Check;
pub use row::{InTank, Row};
pub use tank::Task;

use checks::Subject;
use flown::{Flown, fly};
use mission::PlannerInfo;
use planner_host::PluginDirs;
use rayon::prelude::*;
use scenario::Scenario;
use serde::Serialize;

/// The results of testing one planner with one task.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trial {
    /// Id of the planner.
    pub planner: String,
    /// The task in the tanks.
    pub task: Task,
    /// Seed of the first tank; each further tank has the next number.
    pub first_seed: u64,
    /// The checks and their results.
    pub checks: Vec<Check>,
    /// The results of the missions: first those of this planner, then those of the others in the same tanks.
    pub rows: Vec<Row>,
}

/// A tank in which a planner did not complete its mission.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lost {
    /// The name of the scenario.
    pub name: String,
    /// The scenario, with that planner.
    pub scenario: String,
}

/// The planners with which to compare the planner under test.
#[derive(Debug, Clone, Copy)]
pub struct Others<'a> {
    /// All planners found.
    pub found: &'a [PlannerInfo],
    /// Ids of the planners shipped with tankops; any other planner may be under development and could fail at any time.
    pub shipped: &'a [String],
}

impl Trial {
    /// Tests a planner in `n` tanks, together with the other planners that run such missions. Every planner is tested
    /// on driving to a goal; one that can cover the floor is tested on that, too.
    pub fn all_of(
        planner: &PlannerInfo,
        others: Others<'_>,
        plugins: &PluginDirs,
        tanks: (u64, u64),
    ) -> Vec<Self> {
        let tasks: &[Task] = if planner.covers { &[Task::Cover, Task::Goto] } else { &[Task::Goto] };
        tasks.iter().map(|task| Self::of(planner, *task, others, plugins, tanks)).collect()
    }

    fn of(
        planner: &PlannerInfo,
        task: Task,
        others: Others<'_>,
        plugins: &PluginDirs,
        (n, first_seed): (u64, u64),
    ) -> Self {
        let tanks: Vec<Scenario> = (0..n).map(|i| tank::draw(task, first_seed.wrapping_add(i))).collect();
        let flies_such =
            |other: &&PlannerInfo| other.id != planner.id && (task == Task::Goto || other.covers);
        let beside = others.found.iter().filter(flies_such);
        let ids: Vec<&str> = std::iter::once(planner).chain(beside).map(|info| info.id.as_str()).collect();
        let flights: Vec<(usize, &Scenario)> =
            (0..ids.len()).flat_map(|id| tanks.iter().map(move |tank| (id, tank))).collect();
        let flown: Vec<Flown> = flights.par_iter().map(|(id, tank)| fly(tank, ids[*id], plugins)).collect();
        let rows = ids.iter().zip(flown.chunks(tanks.len().max(1)));
        let mut rows: Vec<Row> = rows.map(|(id, flown)| Row::of(id, flown, first_seed)).collect();
        // A planner that does not run such missions at all cannot be compared.
        rows.retain(|row| row.planner == planner.id || row.unsupported < row.tanks);
        let is_sound = |row: &&Row| row.faults == 0 && others.shipped.contains(&row.planner);
        let beside = rows[1..].iter().filter(is_sound).map(|row| row.planner.as_str()).take(1).collect();
        let subject = Subject { planner, plugins, tank: &tanks[0], beside };
        let checks = if rows[0].unsupported == rows[0].tanks {
            vec![Check::not_made(
                "supports such missions",
                "it reports that it does not support them; nothing was checked",
            )]
        } else {
            checks::all(&subject, &flown[..tanks.len()], first_seed)
        };
        Self { planner: planner.id.clone(), task, first_seed, checks, rows }
    }

    /// Whether every check passed.
    pub fn is_passed(&self) -> bool {
        self.checks.iter().all(|check| check.failure.is_none())
    }

    /// Returns the tanks in which the planner did not complete its mission.
    pub fn lost(&self) -> Vec<Lost> {
        let lost = self.rows.first().into_iter().flat_map(Row::lost);
        let named = |tank: &InTank| Lost {
            name: format!("{}-{}-{}", self.planner, self.task, tank.seed),
            scenario: tank::text(self.task, tank.seed, &self.planner),
        };
        lost.map(named).collect()
    }

    /// Formats checks and rows as text.
    pub fn human(&self) -> String {
        let checks = self.checks.iter().map(Check::line);
        let n = self.rows.first().map_or(0, |row| row.tanks);
        let title = format!(
            "\n{}, {}, in {n} random tanks starting with seed {}:\n",
            self.planner, self.task, self.first_seed
        );
        let lost = self.rows.first().into_iter().flat_map(Row::lost).map(InTank::line);
        checks.chain([title, row::table(&self.rows)]).chain(lost).collect()
    }
}
