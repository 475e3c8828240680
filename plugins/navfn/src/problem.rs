//! The planning problem of a point robot: start and goal among shapes grown by the hull. Unsolvable problems are
//! refused.

use planner_api::{
    Code, Ctx, LogLevel, Plan, PlanRequest, PlannerError, Reason, Result, Site, Task, ZoneKind,
};
use steering::evade;
use world::{
    Boundary, Point, Shape, polyline,
    shortest::{GrownFloor, NoWay, Way},
};

/// Distance kept in addition to the required one, so that rounding never causes contact, metres.
const ROUNDING_M: f64 = 1e-6;
/// Largest distance between points of a plan, so that the mission can locate the robot along it, metres.
const SPACING_M: f64 = 0.2;

/// A solid shape and the distance that the hull centre keeps from it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GrownShape {
    /// The outline of the shape.
    pub shape: Shape,
    /// The distance kept, metres.
    pub keep_m: f64,
}

/// A request with all solids grown by hull and clearance.
///
/// If the start or the goal is closer to a solid than the clearance, the path keeps only the distance that is available
/// there. The robot must be able to leave the start and reach the goal.
#[derive(Debug, Clone)]
pub(crate) struct PlanningProblem {
    /// The start.
    pub start: Point,
    /// The goal.
    pub goal: Point,
    /// The wall.
    pub boundary: Boundary,
    /// The distance that the hull centre keeps from the wall, metres.
    pub wall_keep_m: f64,
    /// Obstacles and no-go zones.
    pub shapes: Vec<GrownShape>,
    /// Obstacles discovered on the goal, with their names. The path leads to the goal anyway.
    pub on_goal: Vec<(String, GrownShape)>,
}

impl PlanningProblem {
    /// Creates the problem of a request for a robot that keeps a clearance of `clearance_m`, or the mission's clearance
    /// if that is larger.
    ///
    /// # Errors
    /// The task is not a goal, or the hull touches something at the start or at the goal.
    pub(crate) fn new(request: &PlanRequest<'_>, clearance_m: f64) -> Result<Self> {
        let Task::Goto { goal, .. } = request.task else {
            let message = "this planner needs a single goal; choose another one for preset paths or coverage";
            return Err(PlannerError::new(Code::Unsupported, message));
        };
        let (site, start) = (request.site, request.start.position);
        if ![start.x, start.y, goal.x, goal.y].iter().all(|x| x.is_finite()) {
            let message = "start and goal coordinates must be finite numbers";
            return Err(PlannerError::new(Code::Invalid, message));
        }
        let hull_m = site.limits.radius_m;
        let wanted_m = hull_m + site.clearance_m.max(clearance_m) + ROUNDING_M;
        // During a mission the estimated position may put the hull in contact with something that it does not touch.
        let least_at_start_m = if *request.reason == Reason::Start { hull_m } else { 0.0 };
        let boundary = site.boundary.to_owned();
        let keep_m = |distance_m: &dyn Fn(Point) -> f64, solid: Solid<'_>| {
            let kept_m = |end, at, least_m| {
                let free_m = distance_m(at);
                fitting(free_m, wanted_m, least_m).ok_or_else(|| refused(site, (end, at), free_m, solid))
            };
            Ok(kept_m(End::Start, start, least_at_start_m)?.min(kept_m(End::Goal, goal, hull_m)?))
        };
        let wall_keep_m = keep_m(&|at| boundary.wall_distance_m(at), Solid::Wall)?;
        // An obstacle discovered on the goal may be moving; its motion is known only after it has been observed for a
        // while.
        let is_on_goal = |(_, discovered, shape): &(String, bool, Shape)| {
            *request.reason != Reason::Start && *discovered && shape.distance_m(goal) < hull_m
        };
        let (on_goal, others): (Vec<_>, Vec<_>) = shapes(site).partition(is_on_goal);
        let before = |(name, _, shape): (String, bool, Shape)| {
            let keep_m = wanted_m.min(shape.distance_m(start));
            (name, GrownShape { shape, keep_m })
        };
        let on_goal = on_goal.into_iter().map(before).collect();
        let shapes = others
            .into_iter()
            .map(|(name, _, shape)| {
                let keep_m = keep_m(&|at| shape.distance_m(at), Solid::Named(&name))?;
                Ok(GrownShape { shape, keep_m })
            })
            .collect::<Result<Vec<GrownShape>>>()?;
        Ok(Self { start, goal, boundary, wall_keep_m, shapes, on_goal })
    }

    /// Turns a path into a plan, and logs a warning if something was discovered on the goal.
    ///
    /// If that obstacle is a disc, the plan still leads to the goal: it may be a moving obstacle, and the console would
    /// not replan when it moves away. If it has any other shape, the plan ends in front of it.
    pub(crate) fn plan_of(&self, way: &Way, ctx: &Ctx<'_>) -> Plan {
        let mut path = polyline::resampled(&way.points(), SPACING_M);
        for (name, grown) in &self.on_goal {
            let what = if matches!(grown.shape, Shape::Disc { .. }) {
                "the robot will continue to the goal if the obstacle moves away"
            } else {
                let is_free = |at: &&Point| grown.shape.distance_m(**at) >= grown.keep_m - ROUNDING_M;
                let clear = path.iter().take_while(is_free).count();
                path.truncate(clear.max(1));
                "the plan ends before the obstacle"
            };
            ctx.log(LogLevel::Warn, &format!("{name} is on the goal; {what}"));
        }
        let complete = self.on_goal.is_empty();
        let cost = if complete { way.length_m } else { polyline::length_m(&path) };
        Plan { path, cost, complete, ..Plan::default() }
    }

    /// The floor for a robot reduced to a point.
    pub(crate) fn grown(&self) -> GrownFloor {
        GrownFloor::new(&self.boundary, self.wall_keep_m, self.shapes.iter().map(|s| (&s.shape, s.keep_m)))
    }
}

/// The distance to keep from a solid that is this far from an end of the path; `None` if that is below the minimum.
fn fitting(distance_m: f64, wanted_m: f64, least_m: f64) -> Option<f64> {
    if distance_m >= wanted_m {
        return Some(wanted_m);
    }
    (distance_m >= least_m - ROUNDING_M && distance_m > ROUNDING_M).then_some(distance_m)
}

/// An end of the requested path.
#[derive(Clone, Copy)]
enum End {
    Start,
    Goal,
}

/// A solid that an end of the path may touch.
#[derive(Clone, Copy)]
enum Solid<'a> {
    Wall,
    Named(&'a str),
}

fn refused(site: &Site<'_>, (end, at): (End, Point), distance_m: f64, solid: Solid<'_>) -> PlannerError {
    let is_outside = matches!(solid, Solid::Wall) && distance_m < 0.0;
    let (code, end) = match (end, is_outside) {
        (End::Start, false) => (Code::StartOccupied, "start"),
        (End::Start, true) => (Code::StartOutside, "start"),
        (End::Goal, false) => (Code::GoalOccupied, "goal"),
        (End::Goal, true) => (Code::GoalOutside, "goal"),
    };
    let solid = match solid {
        Solid::Wall => "the wall",
        Solid::Named(name) => name,
    };
    let message = format!(
        "the {end} touches {solid}: ({:.2}, {:.2}) is only {distance_m:.2} m from it; the hull needs {:.2} m",
        at.x, at.y, site.limits.radius_m
    );
    PlannerError::new(code, message)
}

/// Obstacles and no-go zones, each with its name and whether it was discovered.
fn shapes<'a>(site: &'a Site<'_>) -> impl Iterator<Item = (String, bool, Shape)> + 'a {
    // Moving obstacles are handled in flight: they will be gone when the robot arrives.
    let obstacles = site
        .obstacles
        .iter()
        .filter(|o| !evade::moves(o))
        .map(|o| (format!("obstacle {}", o.id), o.discovered, o.outline.to_owned()));
    let zones = site.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo);
    obstacles.chain(zones.map(|zone| ("a no-go zone".to_owned(), false, zone.outline.to_owned())))
}

/// The reason why there is no path, for the console.
pub(crate) fn refusal(no_way: NoWay, ctx: &Ctx<'_>) -> PlannerError {
    let code = match no_way {
        NoWay::StartBlocked { .. } => Code::StartOccupied,
        NoWay::GoalBlocked { .. } => Code::GoalOccupied,
        NoWay::Unreachable { .. } => {
            return PlannerError::no_path_but(format!("proved: {no_way}"), Vec::new());
        }
        NoWay::Stopped => match ctx.check() {
            Err(stopped) => return stopped,
            Ok(()) => Code::Internal,
        },
    };
    PlannerError::new(code, no_way.to_string())
}
