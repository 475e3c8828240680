//! What one planner makes of one tank.

use super::{Picture, Trial};
use crate::{
    planners::{Planned, Planners},
    study::Problem,
};
use mission::{Cause, Fault};
use nalgebra::Matrix3;
use planner_api::{Code, PlanRequest, PoseEstimate, Reason, Task};
use trials::{
    Haul,
    tanks::{CELL_M, CLEARANCE_M, HULL_M, SWATH_M, Scan, Tank},
};

/// Cells of large tanks are coarser, so that the count takes no longer than the plan, metres.
const COARSE_CELL_M: f64 = 0.1;
/// Radius from which a tank counts as large, metres.
const LARGE_M: f64 = 20.0;
/// Distance from the anchor at which the robot is back, metres.
const TOLERANCE_M: f64 = 0.3;

/// A plan and its figures.
#[derive(Debug, Clone, Default)]
pub(super) struct Measured {
    /// The figures; none if there is no path.
    pub flown: Option<(Scan, Haul)>,
    /// Why there is no path, or not all of it.
    pub reason: Option<String>,
    /// Time between question and answer, milliseconds; none without an answer.
    pub plan_time_ms: Option<f64>,
}

/// Lets a planner plan a tank and shows the plan to whoever draws.
///
/// # Errors
/// There is no such planner, or it refuses its parameters: anything else is a result.
pub(super) fn measure(
    planners: &Planners,
    trial: &Trial,
    gallery: Option<&(dyn Fn(&Picture<'_>) + Sync)>,
) -> Result<Measured, Problem> {
    let tank = &trial.tank;
    let planned = match plan(planners, trial) {
        Err(Problem::Planner { fault, .. }) if is_result(&fault) => {
            return Ok(Measured { reason: Some(fault.message), ..Measured::default() });
        }
        Err(Problem::Planner { fault, .. }) => {
            let case = format!("{} seed {}, {}", trial.case, trial.seed, trial.method.id);
            return Err(Problem::Planner { case, fault });
        }
        planned => planned?,
    };
    let measured = Measured {
        flown: None,
        reason: planned.reason.clone(),
        plan_time_ms: Some(planned.plan_time_ms).filter(|_| planned.path().len() > 1),
    };
    if planned.path().len() < 2 {
        let reason = measured.reason.or_else(|| Some("the plan has no path".into()));
        return Ok(Measured { reason, ..measured });
    }
    match figures(tank, &planned) {
        Err(reason) => Ok(Measured { reason: Some(reason), ..measured }),
        Ok((scan, haul)) => {
            if let Some(show) = gallery {
                show(&Picture {
                    case: trial.case,
                    seed: trial.seed,
                    method: trial.method.id,
                    world: &tank.world(),
                    anchor: tank.anchor,
                    room_m: HULL_M + CLEARANCE_M,
                    swath_m: SWATH_M,
                    plan: &planned.plan,
                    cable: &haul.longest,
                });
            }
            Ok(Measured { flown: Some((scan, haul)), ..measured })
        }
    }
}

/// A planner that breaks down on a tank is a result; one that is not there, or refuses its parameters, is a mistake.
fn is_result(fault: &Fault) -> bool {
    !matches!(fault.cause, Cause::Refused | Cause::Planner(Code::Config))
}

fn plan(planners: &Planners, trial: &Trial) -> Result<Planned, Problem> {
    let Trial { tank, method, .. } = trial;
    let obstacles = tank.obstacles();
    let site = tank.site(&obstacles);
    let start = PoseEstimate { position: tank.anchor, heading_rad: 0.0, covariance: Matrix3::zeros() };
    let task = Task::Cover { anchor: tank.anchor, regions: &[], tether: None, tolerance_m: TOLERANCE_M };
    let request = PlanRequest { reason: &Reason::Start, start, task, site: &site, previous: &[] };
    planners.plan(method.planner, &method.parameters(), &request)
}

fn figures(tank: &Tank, planned: &Planned) -> Result<(Scan, Haul), String> {
    let (low, high) = tank.boundary.bounds();
    let cell_m = if high.x - low.x > 2.0 * LARGE_M { COARSE_CELL_M } else { CELL_M };
    let scan = tank.score(planned.path(), &planned.plan.cuts, cell_m).map_err(|error| error.to_string())?;
    let haul = tank.haul(planned.path()).map_err(|error| error.to_string())?;
    Ok((scan, haul))
}
