//! The result of one planner in one tank.

use crate::study::{Method, Planned, Planners, Result, Runner, StudyError};
use mission::{Cause, Fault};
use planner_api::{Code, Task};
use report::{drawing::plan::Drawn, leg::legs};
use serde::{Deserialize, Serialize};
use trials::{
    Entanglement, Scan,
    tanks::{CELL_M, CLEARANCE_M, HULL_M, SWATH_M, Tank},
};
use world::{Pose, tether::TetherError};

/// Edge length of a cell in large tanks, metres. These cells are coarser, so that counting does not take longer than
/// planning.
const COARSE_CELL_M: f64 = 0.1;
/// Radius from which a tank counts as large, metres.
const LARGE_M: f64 = 20.0;
/// Distance from the anchor at which the robot counts as back, metres.
const TOLERANCE_M: f64 = 0.3;

/// A plan and its figures.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Measured {
    /// The figures; `None` if there is no path.
    pub figures: Option<(Scan, Entanglement)>,
    /// The reason why there is no path, or only part of it.
    pub reason: Option<String>,
    /// Time between request and answer, milliseconds; `None` without an answer.
    pub plan_time_ms: Option<f64>,
}

/// Requests a plan for a tank, and draws the plan if drawings are requested. Case and seed identify the tank.
///
/// # Errors
/// The planner does not exist, or it refuses its parameters. Any other failure is a result.
pub(super) fn measure(
    runner: &Runner<'_>,
    planners: &Planners,
    (case, seed, tank): (&str, u64, &Tank),
    method: &Method,
) -> Result<Measured> {
    let planned = match plan(planners, method, tank) {
        Err(StudyError::Planner { fault, .. }) if is_result(&fault) => {
            return Ok(Measured { reason: Some(fault.message), ..Measured::default() });
        }
        planned => planned?,
    };
    if !planned.has_path() {
        let reason = planned.reason.or_else(|| Some("the plan has no path".into()));
        return Ok(Measured { reason, ..Measured::default() });
    }
    let plan_time_ms = Some(planned.plan_time_ms);
    match figures(tank, &planned) {
        Err(error) => Ok(Measured { figures: None, reason: Some(error.to_string()), plan_time_ms }),
        Ok((scan, entanglement)) => {
            if let Some(gallery) = runner.gallery() {
                let drawn = Drawn {
                    world: &tank.world(),
                    room_m: HULL_M + CLEARANCE_M,
                    swath_m: SWATH_M,
                    preset: None,
                    anchor: Some(tank.anchor),
                    path: planned.path(),
                    legs: &legs(&planned.plan),
                    cuts: &planned.plan.cuts,
                    cable: &entanglement.longest,
                };
                gallery.add((case, seed, &method.id), &drawn);
            }
            Ok(Measured { figures: Some((scan, entanglement)), reason: planned.reason, plan_time_ms })
        }
    }
}

/// A planner that fails in a tank is a result; a missing planner, or refused parameters, is an error.
pub(crate) fn is_result(fault: &Fault) -> bool {
    !matches!(fault.cause, Cause::Refused | Cause::Planner(Code::Config))
}

/// Requests a plan for a tank.
///
/// # Errors
/// The planner does not exist, refuses its parameters, or fails.
pub(crate) fn plan(planners: &Planners, method: &Method, tank: &Tank) -> Result<Planned> {
    let obstacles = tank.obstacles();
    let start = Pose { position: tank.anchor, heading_rad: 0.0 };
    let task = Task::Cover { anchor: tank.anchor, regions: &[], tether: None, tolerance_m: TOLERANCE_M };
    planners.plan(method, start, task, &tank.site(&obstacles))
}

fn figures(tank: &Tank, planned: &Planned) -> Result<(Scan, Entanglement), TetherError> {
    let (low, high) = tank.boundary.bounds();
    let cell_m = if high.x - low.x > 2.0 * LARGE_M { COARSE_CELL_M } else { CELL_M };
    Ok((tank.score(planned.path(), &planned.plan.cuts, cell_m)?, tank.entanglement(planned.path())?))
}
