//! Plans by walking the law over the known map.

use crate::{
    descent::{self, Descent},
    ends::{check_goal, check_start},
    lockstep::{self, PresetPath},
    outcome::Walk,
    rollout,
    scene::Scene,
    settings::{FieldSettings, Planning},
};
use geometry::{Point, polyline};
use planner_api::{Code, Ctx, Plan, PlanRequest, PlannerError, Result, Site, Task};
use steering::evade;

/// Maximum number of preset points after long gaps are split.
const MOST_POINTS: usize = 200_000;

/// Returns a path for the task. `complete` states whether it achieves the whole task with the required clearance; if
/// not, the log gives the reason.
///
/// # Errors
/// [`Code::StartOccupied`], [`Code::StartOutside`], [`Code::GoalOccupied`], [`Code::GoalOutside`], [`Code::Invalid`]
/// for preset points that coincide or are missing, and any error that ends the call early.
pub fn plan(settings: &FieldSettings, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
    let standing = evade::standing(request.site);
    let obstacles = if settings.evades { standing.as_slice() } else { request.site.obstacles };
    let scene = Scene::new(&Site { obstacles, ..*request.site });
    check_start(&scene, request.start.position, request.site.limits.radius_m)?;
    match request.task {
        Task::Goto { goal, tolerance_m } => check_goal(&scene, goal, tolerance_m)?,
        Task::Follow { targets, .. } => check_targets(&scene, targets)?,
        Task::Cover { .. } => {
            return Err(PlannerError::new(
                Code::Unsupported,
                "plans to goals and along preset paths, but does not cover floors",
            ));
        }
    }
    let walk = if is_flown(settings.planning, request.site.limits.radius_m) {
        rollout::fly(&scene, settings, request, ctx)?
    } else {
        walked(&scene, settings, request, ctx)?
    };
    let clearance_m = scene.path_clearance_m(&walk.path);
    Ok(walk.into_plan(clearance_m, request.site.clearance_m, ctx))
}

fn is_flown(planning: Planning, radius_m: f64) -> bool {
    match planning {
        Planning::Walked => false,
        Planning::Flown => true,
        Planning::ByHull => radius_m > 0.0,
    }
}

fn walked(scene: &Scene, settings: &FieldSettings, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Walk> {
    let start = request.start.position;
    match request.task {
        Task::Goto { goal, tolerance_m } | Task::Cover { anchor: goal, tolerance_m, .. } => {
            let step_m = settings.walking.goto_step_m;
            descent::descend(scene, settings, &Descent { start, goal, step_m, tolerance_m }, ctx)
        }
        Task::Follow { targets, tolerance_m } => {
            let points = course(scene, settings.walking.step_m, targets)?;
            lockstep::follow(scene, settings, &PresetPath { start, points: &points, tolerance_m }, ctx)
        }
    }
}

/// The preset points up to the last free one, with long gaps split into steps.
fn course(scene: &Scene, step_m: f64, targets: &[Point]) -> Result<Vec<Point>> {
    let split = polyline::length_m(targets) / step_m + targets.len() as f64;
    if split > MOST_POINTS as f64 {
        let message =
            format!("the preset path has {split:.0} steps of {step_m} m; at most {MOST_POINTS} are allowed");
        return Err(PlannerError::new(Code::Invalid, message));
    }
    let last = targets.iter().rposition(|p| scene.hull_clearance_m(*p) >= 0.0).unwrap_or(0);
    // Slightly more than the step, so that rounding does not split points one step apart.
    Ok(polyline::resampled(&targets[..=last], step_m * (1.0 + 1e-9)))
}

fn check_targets(scene: &Scene, targets: &[Point]) -> Result<()> {
    if targets.is_empty() {
        return Err(PlannerError::new(Code::Invalid, "the preset path has no points"));
    }
    if let Some(at) = targets.windows(2).position(|w| (w[1] - w[0]).norm() < 1e-9) {
        let message = format!("preset points {at} and {} coincide; remove one of them", at + 1);
        return Err(PlannerError::new(Code::Invalid, message));
    }
    if targets.iter().all(|p| scene.hull_clearance_m(*p) < 0.0) {
        return Err(PlannerError::new(Code::NoPath, "every preset point is inside an obstacle"));
    }
    Ok(())
}
