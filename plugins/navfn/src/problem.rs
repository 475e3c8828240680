//! What a request asks of a point robot: its start and goal among shapes grown by the hull, and how it refuses.

use planner_api::{
    Code, Ctx, LogLevel, Plan, PlanRequest, PlannerError, Reason, Result, Site, Task, ZoneKind,
};
use steering::evade;
use world::{
    Boundary, Point, Shape, polyline,
    shortest::{GrownFloor, NoWay, Way},
};

/// Kept beyond what is demanded, so that no rounding counts as a touch, metres.
const ROUNDING_M: f64 = 1e-6;
/// Points of a plan are no further apart than this, so that the mission can locate the robot along it, metres.
const SPACING_M: f64 = 0.2;

/// The shape of something solid and what the middle of the robot keeps from it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GrownShape {
    /// Its outline.
    pub shape: Shape,
    /// The distance kept, metres.
    pub keep_m: f64,
}

/// A request with everything solid grown by hull and clearance.
///
/// Where the robot stands, or its goal lies, nearer to something than the clearance, it keeps as much from it as there
/// is: it must be able to get away, and in.
#[derive(Debug, Clone)]
pub(crate) struct PlanningProblem {
    /// From where.
    pub start: Point,
    /// To where.
    pub goal: Point,
    /// The wall.
    pub boundary: Boundary,
    /// What the middle of the robot keeps from the wall, metres.
    pub wall_keep_m: f64,
    /// Obstacles and no-go zones.
    pub shapes: Vec<GrownShape>,
    /// What was discovered on the goal, with its name; the way leads there all the same.
    pub on_goal: Vec<(String, GrownShape)>,
}

impl PlanningProblem {
    /// The problem of a request for a robot that keeps this clearance, or the mission's if that is larger, metres.
    ///
    /// # Errors
    /// The task is not to reach a goal, or the hull touches something at the start or at the goal.
    pub(crate) fn new(request: &PlanRequest<'_>, clearance_m: f64) -> Result<Self> {
        let Task::Goto { goal, .. } = request.task else {
            let message = "plans to single goals only; take a planner for preset paths or coverage";
            return Err(PlannerError::new(Code::Unsupported, message));
        };
        let (site, start) = (request.site, request.start.position);
        if ![start.x, start.y, goal.x, goal.y].iter().all(|x| x.is_finite()) {
            return Err(PlannerError::new(Code::Invalid, "start and goal must be finite numbers"));
        }
        let hull_m = site.limits.radius_m;
        let wanted_m = hull_m + site.clearance_m.max(clearance_m) + ROUNDING_M;
        // Under way the estimate may have the hull touch what it does not touch.
        let least_at_start_m = if *request.reason == Reason::Start { hull_m } else { 0.0 };
        let boundary = site.boundary.to_owned();
        let keep_m = |distance_m: &dyn Fn(Point) -> f64, what: &str| {
            fitting(distance_m(start), wanted_m, least_at_start_m)
                .ok_or_else(|| refused(site, start, distance_m(start), &format!("start touches {what}")))
                .and_then(|at_start_m| {
                    let at_goal_m = fitting(distance_m(goal), wanted_m, hull_m).ok_or_else(|| {
                        refused(site, goal, distance_m(goal), &format!("goal touches {what}"))
                    })?;
                    Ok(at_start_m.min(at_goal_m))
                })
        };
        let wall_keep_m = keep_m(&|at| boundary.wall_distance_m(at), "the wall")?;
        // What is discovered on the goal may be on its way: when it was seen for a while, it will be known.
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
                let keep_m = keep_m(&|at| shape.distance_m(at), &name)?;
                Ok(GrownShape { shape, keep_m })
            })
            .collect::<Result<Vec<GrownShape>>>()?;
        Ok(Self { start, goal, boundary, wall_keep_m, shapes, on_goal })
    }

    /// A way as a plan; it says so where something was discovered on the goal.
    ///
    /// The plan leads up to a disc: moving obstacles are seen as discs, and the console replans only for what comes into
    /// the way. Before any other shape the plan ends.
    pub(crate) fn plan_of(&self, way: &Way, ctx: &Ctx<'_>) -> Plan {
        let mut path = polyline::resampled(&way.points(), SPACING_M);
        for (name, grown) in &self.on_goal {
            let what = if matches!(grown.shape, Shape::Disc { .. }) {
                "the robot goes on in case it moves away"
            } else {
                let is_free = |at: &&Point| grown.shape.distance_m(**at) >= grown.keep_m - ROUNDING_M;
                let clear = path.iter().take_while(is_free).count();
                path.truncate(clear.max(1));
                "the plan ends before it"
            };
            ctx.log(LogLevel::Warn, &format!("{name} is on the goal; {what}"));
        }
        let complete = self.on_goal.is_empty();
        let cost = if complete { way.length_m } else { polyline::length_m(&path) };
        Plan { path, cost, complete, ..Plan::default() }
    }

    /// The floor on which the robot is a point.
    pub(crate) fn grown(&self) -> GrownFloor {
        GrownFloor::new(&self.boundary, self.wall_keep_m, self.shapes.iter().map(|s| (&s.shape, s.keep_m)))
    }
}

/// What is kept from something that is this far from an end of the way; none if that is less than the least.
fn fitting(distance_m: f64, wanted_m: f64, least_m: f64) -> Option<f64> {
    if distance_m >= wanted_m {
        return Some(wanted_m);
    }
    (distance_m >= least_m - ROUNDING_M && distance_m > ROUNDING_M).then_some(distance_m)
}

fn refused(site: &Site<'_>, at: Point, distance_m: f64, what: &str) -> PlannerError {
    let is_start = what.starts_with("start");
    let outside = what.ends_with("the wall") && distance_m < 0.0;
    let code = match (is_start, outside) {
        (true, false) => Code::StartOccupied,
        (true, true) => Code::StartOutside,
        (false, false) => Code::GoalOccupied,
        (false, true) => Code::GoalOutside,
    };
    let message = format!(
        "the {what}: ({:.2}, {:.2}) is {distance_m:.2} m from it, the hull needs {:.2} m",
        at.x, at.y, site.limits.radius_m
    );
    PlannerError::new(code, message)
}

/// Obstacles and no-go zones with what they are called and whether they were discovered.
fn shapes<'a>(site: &'a Site<'_>) -> impl Iterator<Item = (String, bool, Shape)> + 'a {
    // What moves is left to the flight: by the time the robot is there it will be gone.
    let obstacles = site
        .obstacles
        .iter()
        .filter(|o| !evade::moves(o))
        .map(|o| (format!("obstacle {}", o.id), o.discovered, o.outline.to_owned()));
    let zones = site.zones.iter().filter(|zone| zone.kind == ZoneKind::NoGo);
    obstacles.chain(zones.map(|zone| ("a no-go zone".to_owned(), false, zone.outline.to_owned())))
}

/// Why there is no way, for the console.
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
