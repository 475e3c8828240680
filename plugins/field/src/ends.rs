//! Checks of the start and the goal of a path.

use crate::scene::Scene;
use geometry::Point;
use planner_api::{Code, PlanRequest, PlannerError, Result, Site, Task};
use steering::evade;

/// Distance outside the floor that is attributed to rounding, metres.
const ROUNDING_M: f64 = 1e-6;

/// Returns the goal of a request and its tolerance, metres, after checking start and goal. `id` names the planner in
/// messages.
///
/// # Errors
/// [`Code::Unsupported`] for a preset path, and those of [`check_start`] and [`check_goal`].
pub fn single_goal(request: &PlanRequest<'_>, id: &str) -> Result<(Point, f64)> {
    let Task::Goto { goal, tolerance_m } = request.task else {
        let message = format!("{id} plans to single goals only; for preset paths choose apf or rpf");
        return Err(PlannerError::new(Code::Unsupported, message));
    };
    // An obstacle moving over the goal now will be gone when the robot arrives.
    let scene = Scene::new(&Site { obstacles: &evade::standing(request.site), ..*request.site });
    check_start(&scene, request.start.position, request.site.limits.radius_m)?;
    check_goal(&scene, goal, tolerance_m)?;
    Ok((goal, tolerance_m))
}

/// Refuses a start outside the tank or deep inside an obstacle.
///
/// # Errors
/// [`Code::StartOutside`], [`Code::StartOccupied`].
pub fn check_start(scene: &Scene, start: Point, radius_m: f64) -> Result<()> {
    let place = format!("the start ({:.2}, {:.2})", start.x, start.y);
    if scene.wall_clearance_m(start) + radius_m < -ROUNDING_M {
        return Err(PlannerError::new(Code::StartOutside, format!("{place} lies outside the tank")));
    }
    // The estimated start may be slightly wrong, so it is refused only if half of the hull is inside.
    let depth_m = -scene.hull_clearance_m(start);
    if depth_m > radius_m / 2.0 {
        let message = format!("at {place} the hull is {depth_m:.2} m inside an obstacle");
        return Err(PlannerError::new(Code::StartOccupied, message));
    }
    Ok(())
}

/// Refuses a goal that is out of reach by more than the tolerance.
///
/// # Errors
/// [`Code::GoalOutside`], [`Code::GoalOccupied`].
pub fn check_goal(scene: &Scene, goal: Point, tolerance_m: f64) -> Result<()> {
    let place = format!("the goal ({:.2}, {:.2})", goal.x, goal.y);
    if scene.wall_clearance_m(goal) + tolerance_m < -ROUNDING_M {
        return Err(PlannerError::new(
            Code::GoalOutside,
            format!("{place} lies outside the tank or in its wall"),
        ));
    }
    if scene.hull_clearance_m(goal) + tolerance_m < 0.0 {
        return Err(PlannerError::new(Code::GoalOccupied, format!("{place} lies in an obstacle")));
    }
    Ok(())
}
