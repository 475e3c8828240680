//! Rows of one method on one group of layouts.

use super::{
    group::CLEARANCE_M,
    method::{Pairing, Set},
    plans::{Measured, Run},
};
use crate::study::{Block, Row, Sample};

/// Tolerance for rounding of clearances, metres.
const ROUNDING_M: f64 = 1e-6;

/// The criterion for success.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Success {
    /// The paper's criterion: arrives, is not trapped, lags by at most one coil; collisions do not count.
    Walk,
    /// Our criterion: arrives, keeps the clearance and stays inside the wall.
    Safe,
}

impl Success {
    fn is_ok(self, plan: &Measured) -> bool {
        let is_ok = match self {
            Self::Walk => plan.walk.is_ok(),
            Self::Safe => plan.planned.plan.complete && plan.safety.is_ok(CLEARANCE_M),
        };
        plan.has_path() && is_ok
    }
}

/// All rows of the plans of a run.
pub(super) fn rows(block: &Block<'_>, run: &Run, plans: &[Measured], success: Success) -> Vec<Row> {
    let mut rows = outcome(block, plans, success);
    rows.extend(tracking(block, plans, run));
    rows.extend(safety(block, plans));
    let times: Sample = plans.iter().map(|plan| plan.planned.plan_time_ms).collect();
    rows.extend(block.mean_and_median("plan_time_ms", &times, "ms"));
    rows
}

/// The number of plans that arrive, and the outcome of the other plans.
fn outcome(block: &Block<'_>, plans: &[Measured], success: Success) -> Vec<Row> {
    let n = plans.len();
    let count = |is: &dyn Fn(&Measured) -> bool| plans.iter().filter(|plan| is(plan)).count();
    let n_without = n - count(&Measured::has_path);
    let n_refused = count(&|plan| !plan.planned.plan.complete && says(plan, "blocked"));
    let n_proved = count(&|plan| says(plan, "blocked") && says(plan, "proved:"));
    let note = match n_without {
        0 => block.note.to_owned(),
        _ => join(
            block.note,
            &format!("{n_without} of {n} layouts give no path, because the start is blocked"),
        ),
    };
    let proved_rate = (n_refused > 0).then(|| n_proved as f64 / n_refused as f64);
    let touches = |plan: &Measured| plan.has_path() && plan.safety.clearance_m < CLEARANCE_M - ROUNDING_M;
    let leaves = |plan: &Measured| plan.has_path() && plan.safety.wall_m < -ROUNDING_M;
    let collisions = "layouts whose path comes nearer than 0.3 m to an obstacle point; the paper does not count collisions";
    vec![
        block.row("ok_rate", count(&|plan| success.is_ok(plan)) as f64 / n as f64, "", n).note(note),
        block.row("blocked_proved_rate", proved_rate, "", n_refused),
        block.row("collisions", count(&touches) as f64, "layouts", n).note(join(block.note, collisions)),
        block.row("wall_exits", count(&leaves) as f64, "layouts", n),
    ]
}

fn tracking(block: &Block<'_>, plans: &[Measured], run: &Run) -> Vec<Row> {
    let printed = run.printed;
    let mut rows = Vec::new();
    let mut add = |metric, figure: fn(&Measured) -> f64, unit, paper: Option<f64>| {
        let sample = with_path(plans).map(figure).collect();
        let with_printed = |row: Row| {
            let row = row.printed(paper);
            if run.set == Set::Text { row } else { row.fitted() }
        };
        rows.extend(block.mean_and_median(metric, &sample, unit).map(with_printed));
    };
    let (precision, rmse_m) = (printed.map(|p| p.precision), printed.map(|p| p.rmse_m));
    match run.pairing {
        Pairing::Index | Pairing::Ahead => {
            add("precision", |p| p.score.precision, "", precision);
            add("recall", |p| p.score.recall, "", printed.map(|p| p.recall));
            add("rmse", |p| p.score.rmse_m, "m", rmse_m);
        }
        Pairing::Forward => {
            add("precision", |p| p.score.cross_track_precision, "", None);
            add("recall", |p| p.score.covered, "", None);
            add("rmse", |p| p.score.cross_track_rmse_m, "m", None);
        }
    }
    add("cross_track_precision", |p| p.score.cross_track_precision, "", precision);
    add("cross_track_rmse", |p| p.score.cross_track_rmse_m, "m", rmse_m);
    add("coverage", |p| p.score.covered, "", None);
    add("floor_rmse", |p| p.floor_m, "m", None);
    rows
}

fn safety(block: &Block<'_>, plans: &[Measured]) -> Vec<Row> {
    let clearances: Sample = with_path(plans).map(|plan| plan.safety.clearance_m).collect();
    let turns: Sample = with_path(plans).map(|plan| plan.safety.heading_step_rad.to_degrees()).collect();
    let n = clearances.len();
    vec![
        block.row("min_clearance", clearances.mean(), "m", n),
        block.row("min_clearance_least", clearances.min(), "m", n),
        block.row("max_heading_step_deg", turns.mean(), "deg", turns.len()),
        block.row("max_heading_step_deg_worst", turns.max(), "deg", turns.len()),
    ]
}

/// The plans that have a path.
pub(super) fn with_path(plans: &[Measured]) -> impl Iterator<Item = &Measured> {
    plans.iter().filter(|plan| plan.has_path())
}

/// Joins two notes.
pub(super) fn join(a: &str, b: &str) -> String {
    if a.is_empty() || b.is_empty() { format!("{a}{b}") } else { format!("{a}; {b}") }
}

fn says(plan: &Measured, what: &str) -> bool {
    plan.planned.reason.as_ref().is_some_and(|reason| reason.contains(what))
}
