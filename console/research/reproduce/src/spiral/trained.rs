//! Planners with any parameters on the layouts, for tuning.

use super::{
    figures::{Success, rows},
    group::{CLEARANCE_M, Group},
    method::{Pairing, Set},
    plans::{Measured, Run, plan_all},
};
use crate::study::{Block, Method, Result, Row, Runner};

/// Cap on the error, metres: for a lost walk, the distance does not matter.
const ERROR_MAX_M: f64 = 2.0;

/// A planner with some parameters, on some layouts.
pub(crate) struct Trained {
    run: Run,
    plans: Vec<Measured>,
}

impl Trained {
    /// Asks a planner for plans on the layouts of these seeds.
    pub(crate) fn new(runner: &Runner<'_>, seeds: &[u64], method: Method, group: Group) -> Result<Self> {
        let run =
            Run { case: group.id(), method, group, printed: None, pairing: Pairing::Index, set: Set::Text };
        let plans = plan_all(runner, seeds, std::slice::from_ref(&run))?.pop().unwrap_or_default();
        Ok(Self { run, plans })
    }

    /// Mean over the layouts of a sum: the cross-track error (metres, at most 2), 1 if the path does not arrive in
    /// order, and up to 1 for a lack of clearance.
    pub(crate) fn loss(&self) -> f64 {
        self.plans.iter().map(loss_of).sum::<f64>() / self.plans.len().max(1) as f64
    }

    /// The rows of the planner.
    pub(crate) fn rows(&self) -> Vec<Row> {
        let block = Block { table: "tune", case: &self.run.case, method: &self.run.method.id, note: "" };
        rows(&block, &self.run, &self.plans, Success::Walk)
    }
}

fn loss_of(plan: &Measured) -> f64 {
    if !plan.has_path() {
        return ERROR_MAX_M + 2.0;
    }
    let lacking = 1.0 - plan.safety.clearance_m.clamp(0.0, CLEARANCE_M) / CLEARANCE_M;
    plan.score.cross_track_rmse_m.min(ERROR_MAX_M) + lacking + f64::from(!plan.walk.is_ok())
}
