//! Planners with any parameters on the layouts, for tuning.

use super::{
    CLEARANCE_M, Group,
    figures::{Place, Success},
    method::{Method, Pairing},
    plans::{Measured, Run, plan_all},
};
use crate::{
    bench::Bench,
    row::Row,
    study::{Options, Problem},
};
use mission::Parameters;

/// The error counts up to this, metres: a walk that is lost is no worse for being lost far away.
const MOST_ERROR_M: f64 = 2.0;

/// Mean over the layouts of: the cross-track error (metres, at most 2), 1 if the path does not arrive in order, and up to
/// 1 for what it lacks of the clearance.
///
/// # Errors
/// The planner is missing, refuses the parameters or breaks down.
pub fn loss(
    bench: &Bench<'_>,
    options: &Options,
    planner: &str,
    parameters: &Parameters,
    group: Group,
) -> Result<f64, Problem> {
    let plans = plans(bench, options, (planner, planner), parameters, group)?;
    Ok(plans.iter().map(loss_of).sum::<f64>() / plans.len().max(1) as f64)
}

fn loss_of(plan: &Measured) -> f64 {
    if !plan.has_path() {
        return MOST_ERROR_M + 2.0;
    }
    let lacking = 1.0 - plan.safety.clearance_m.clamp(0.0, CLEARANCE_M) / CLEARANCE_M;
    plan.score.cross_track_rmse_m.min(MOST_ERROR_M) + lacking + f64::from(!plan.verdict.is_ok())
}

/// Rows of a planner with its id in rows.
///
/// # Errors
/// The planner is missing, refuses the parameters or breaks down.
pub fn figures_of(
    bench: &Bench<'_>,
    options: &Options,
    planner: (&str, &str),
    parameters: &Parameters,
    group: Group,
) -> Result<Vec<Row>, Problem> {
    let plans = plans(bench, options, planner, parameters, group)?;
    let place = Place { table: "tune", case: &group.id(), method: planner.1, note: "" };
    Ok(place.rows(&plans, Success::Walk, None, Pairing::Index))
}

fn plans(
    bench: &Bench<'_>,
    options: &Options,
    (planner, id): (&str, &str),
    parameters: &Parameters,
    group: Group,
) -> Result<Vec<Measured>, Problem> {
    let method = Method {
        id: id.to_owned(),
        planner: planner.to_owned(),
        parameters: parameters.clone(),
        printed: [None; 3],
        note: "",
        pairing: Pairing::Index,
    };
    let run = Run { is_as_given: true, ..Run::new(&method, group) };
    Ok(plan_all(bench, options, &[run], 0)?.pop().unwrap_or_default())
}
