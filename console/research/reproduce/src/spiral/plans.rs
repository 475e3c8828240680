//! Plans of many layouts.

use super::{
    group::{CLEARANCE_M, Group},
    method::{Entry, Pairing, Set},
    printed::Printed,
};
use crate::study::{Block, Gallery, Job, Method, Planned, Planners, Result, Runner, StudyError};
use planner_api::{Motion, Task};
use serde::{Deserialize, Serialize};
use trials::{Layout, Safety, Score, WalkOutcome, discs, floor_rmse_m, safety, score_paired, targets_ahead};
use world::{Boundary, Pose};

/// Distance from the centre at which the spiral ends, metres; the paper's `d0`.
const TOLERANCE_M: f64 = 0.2;

/// One plan and its figures.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Measured {
    /// The answer.
    pub planned: Planned,
    /// Figures against the preset path.
    pub score: Score,
    /// Clearances and turns.
    pub safety: Safety,
    /// Success in the sense of the paper, as far as it can be defined.
    pub walk: WalkOutcome,
    /// The least root mean square error possible with the clearance, metres.
    pub floor_m: f64,
}

impl Measured {
    fn of(planned: Planned, layout: &Layout, pairing: Pairing) -> Self {
        let path = planned.path();
        let ahead = (pairing == Pairing::Ahead).then(|| targets_ahead(path, &layout.path));
        let targets = ahead.as_ref().unwrap_or(&layout.path);
        Self {
            score: score_paired(path, targets, &layout.path),
            safety: safety(path, &layout.path, &layout.columns, layout.radius_m),
            walk: WalkOutcome::of(path, targets, &layout.path),
            floor_m: floor_rmse_m(&layout.path, &layout.columns, CLEARANCE_M),
            planned,
        }
    }

    /// Whether the answer contains a path.
    pub(super) fn has_path(&self) -> bool {
        self.planned.has_path()
    }
}

/// A method on the layouts of a group.
pub(super) struct Run {
    /// Id of the case.
    pub case: String,
    /// The method, with all its parameters.
    pub method: Method,
    /// The layouts.
    pub group: Group,
    /// The printed values; `None` where planning failed or nothing is printed.
    pub printed: Option<Printed>,
    /// The rule that assigns a preset point to a planned point.
    pub pairing: Pairing,
    /// The family of the method.
    pub set: Set,
}

impl Run {
    /// A column of a table on the layouts of a group, with the group's obstacle range.
    pub(super) fn new(entry: &Entry, group: Group) -> Self {
        let mut method = entry.method.clone();
        // Our own planners have a clearance, not an obstacle range.
        if method.parameters.contains_key("k_att") {
            method = method.number("rho_0_m", group.distribution.rho_0_m());
        }
        let printed = entry.printed[group.column()];
        let set = entry.set.clone();
        Self { case: group.id(), method, group, printed, pairing: entry.pairing, set }
    }

    /// The rows of the run.
    pub(super) fn block(&self, job: &Job<'_>) -> Block<'_> {
        job.block(&self.case, &self.method.id, self.method.note)
    }

    fn plan(&self, planners: &Planners, seed: u64, gallery: Option<&Gallery>) -> Result<Measured> {
        let layout = self.group.distribution.layout(self.group.sampling, seed, CLEARANCE_M);
        let obstacles = layout.obstacles();
        let site = layout.site(&obstacles, Motion::Point);
        let start = Pose { position: layout.path[0], heading_rad: 0.0 };
        let task = Task::Follow { targets: &layout.path, tolerance_m: TOLERANCE_M };
        let planned = planners.plan(&self.method, start, task, &site);
        let in_case = |e: StudyError| e.in_case(format!("{} seed {seed}, {}", self.case, self.method.id));
        let measured = Measured::of(planned.map_err(in_case)?, &layout, self.pairing);
        if let Some(gallery) = gallery {
            let wall = Boundary::Circle { radius_m: layout.radius_m };
            let world = discs::world(wall, &layout.columns);
            let name = (&*self.case, seed, &*self.method.id);
            gallery.add_path(name, &world, CLEARANCE_M, Some(&layout.path), &measured.planned.plan);
        }
        Ok(measured)
    }
}

/// Plans every run on every layout; one list for each run, in the order of the seeds.
pub(super) fn plan_all(runner: &Runner<'_>, seeds: &[u64], runs: &[Run]) -> Result<Vec<Vec<Measured>>> {
    runner.grid(runs, seeds, |planners, run, seed| run.plan(planners, *seed, runner.gallery()))
}
