//! Plans of many layouts.

use super::{CLEARANCE_M, Group, method::Method};
use crate::{
    bench::Bench,
    planners::{Planned, Planners},
    study::{Options, Problem},
};
use mission::{ParamValue, Parameters};
use nalgebra::Matrix3;
use planner_api::{Motion, PlanRequest, PoseEstimate, Reason, Task};
use trials::{Layout, Safety, Score, Verdict, floor_rmse_m, safety, score, verdict};
use world::Point;

/// The spiral is at its end this near to the centre, metres; the paper's `d0`.
const TOLERANCE_M: f64 = 0.2;

/// One plan and its figures.
#[derive(Debug, Clone)]
pub(super) struct Measured {
    /// The path; empty if there is none.
    pub path: Vec<Point>,
    /// Whether the planner says that it achieves the task.
    pub says_complete: bool,
    /// Why not.
    pub reason: Option<String>,
    /// Time of the plan, milliseconds.
    pub plan_time_ms: f64,
    /// Figures against the preset path.
    pub score: Score,
    /// Clearances and turns.
    pub safety: Safety,
    /// The paper's success, as far as it can be defined.
    pub verdict: Verdict,
    /// The least root mean square error possible with the clearance, metres.
    pub floor_m: f64,
}

impl Measured {
    /// Whether there is a path at all.
    pub(super) fn has_path(&self) -> bool {
        self.path.len() > 1
    }
}

/// A method on the layouts of a group.
pub(super) struct Run {
    /// The method.
    pub method: Method,
    /// The layouts.
    pub group: Group,
    /// Range of obstacles, metres; the distribution's if none.
    pub rho_0_m: Option<f64>,
    /// Whether the parameters are complete as they are.
    pub is_as_given: bool,
}

impl Run {
    /// A method on the layouts of a group, with the group's range of obstacles.
    pub(super) fn new(method: &Method, group: Group) -> Self {
        Self { method: method.clone(), group, rho_0_m: None, is_as_given: false }
    }

    fn parameters(&self) -> Parameters {
        let mut parameters = self.method.parameters.clone();
        // Our own planners know a clearance, not a range of obstacles.
        if !self.is_as_given && parameters.contains_key("k_att") {
            let rho_0_m = self.rho_0_m.unwrap_or_else(|| self.group.distribution.rho_0_m());
            parameters.insert("rho_0_m".into(), ParamValue::Float(rho_0_m));
        }
        parameters
    }

    fn plan(&self, planners: &Planners, seed: u64) -> Result<Measured, Problem> {
        let layout = self.group.distribution.layout(self.group.sampling, seed, CLEARANCE_M);
        let planned = ask(planners, &self.method.planner, &self.parameters(), &layout);
        planned.map(|planned| measure(planned, &layout)).map_err(|problem| match problem {
            Problem::Planner { fault, .. } => Problem::Planner {
                case: format!("{} seed {seed}, {}", self.group.id(), self.method.id),
                fault,
            },
            problem @ Problem::Nothing(_) => problem,
        })
    }
}

/// Plans every run on every layout; one list for each run, in the order of the seeds.
pub(super) fn plan_all(
    bench: &Bench<'_>,
    options: &Options,
    runs: &[Run],
    layouts: usize,
) -> Result<Vec<Vec<Measured>>, Problem> {
    let cases: Vec<(usize, u64)> =
        (0..runs.len()).flat_map(|run| options.seeds(layouts).map(move |seed| (run, seed))).collect();
    let mut measured =
        bench.map(&cases, |planners, (run, seed)| runs[*run].plan(planners, *seed))?.into_iter();
    let n_seeds = options.seeds(layouts).count();
    Ok(runs.iter().map(|_| measured.by_ref().take(n_seeds).collect()).collect())
}

fn ask(
    planners: &Planners,
    planner: &str,
    parameters: &Parameters,
    layout: &Layout,
) -> Result<Planned, Problem> {
    let obstacles = layout.obstacles();
    let site = layout.site(&obstacles, Motion::Point);
    let start = PoseEstimate { position: layout.path[0], heading_rad: 0.0, covariance: Matrix3::zeros() };
    let task = Task::Follow { targets: &layout.path, tolerance_m: TOLERANCE_M };
    let request = PlanRequest { reason: &Reason::Start, start, task, site: &site, previous: &[] };
    planners.plan(planner, parameters, &request)
}

fn measure(planned: Planned, layout: &Layout) -> Measured {
    let path = planned.plan.path;
    Measured {
        score: score(&path, &layout.path),
        safety: safety(&path, &layout.path, &layout.columns, layout.radius_m),
        verdict: verdict(&path, &layout.path),
        floor_m: floor_rmse_m(&layout.path, &layout.columns, CLEARANCE_M),
        says_complete: planned.plan.complete,
        reason: planned.reason,
        plan_time_ms: planned.plan_time_ms,
        path,
    }
}
