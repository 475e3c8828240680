//! The tangent follower: our reactive planner for preset paths.

use crate::{
    course::{self, Course},
    pursuit::Pursuit,
    refusal,
    walk::Walk,
};
use geometry::convex::Part;
use planner_api::{
    Caps, Code, Command, Config, Ctx, LogLevel, ParamSpec, Plan, PlanRequest, Planner, PlannerError, Result,
    Sensed, Site, float,
};
use steering::{params as p, solid_parts};
use world::polyline;

/// Beyond clearance the robot has to see at least this far, metres.
const LEAST_SIGHT_M: f64 = 0.5;

const RANGE: ParamSpec = float("range_m", "Sensing range", "m", 0.5, 10.0, 1.2)
    .help("Obstacles further from the middle of the robot are not taken into account; never more than it senses.")
    .group("Plan");
const STEP: ParamSpec = float("step_m", "Longest move", "m", 0.01, 0.3, 0.1)
    .help("Length of a move of the plan; shorter ones pass obstacles more closely to the clearance.")
    .group("Plan");

/// Follows a preset path, or a plan of another planner, by what the robot senses.
///
/// Straight to the next free point; past what is in the way along the tangent of the headings it blocks, on the side
/// that misses less floor. Where neither side leads on, in a pocket, it goes the shortest way back to the course among
/// all that it has sensed so far. It never goes where hull and clearance have no room.
pub struct SpiralTangent {
    clearance_m: f64,
    range_m: f64,
    step_m: f64,
    pursuit: Pursuit,
}

impl Planner for SpiralTangent {
    const ID: &'static str = "spiral-tangent";
    const NAME: &'static str = "Tangent follower";
    const ABOUT: &'static str = "Reactive: follows a preset path or a plan by what is sensed, past obstacles along their \
                                 tangents, with hard clearance and wall; takes what moves as standing.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL);
    const PARAMS: &'static [ParamSpec] =
        &[p::CLEARANCE, RANGE, STEP, p::GUARD, p::GUARD_SIGMAS, p::SLOW, p::MIN_SHARE, p::STUCK];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        course::check_numbers(config, Self::PARAMS)?;
        let clearance_m = config.float("clearance_m");
        let hull_m = site.limits.radius_m;
        let range_m = config.float("range_m").min(site.limits.sensing_range_m + hull_m);
        let least_m = hull_m + clearance_m.max(site.clearance_m) + LEAST_SIGHT_M;
        if range_m < least_m {
            let message = format!(
                "a range of {range_m:.2} m is too short for hull and clearance; {least_m:.2} m are needed, or less \
                 clearance"
            );
            return Err(PlannerError::new(Code::Config, message));
        }
        Ok(Self {
            clearance_m,
            range_m,
            step_m: config.float("step_m").max(0.005),
            pursuit: Pursuit::new(p::flight(config), clearance_m, site),
        })
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let course = Course::new(request)?;
        let room = course::room(request.site, self.clearance_m, &course)?;
        course::check_start(request, &course, &room, ctx)?;
        let parts: Vec<Part> = solid_parts(request.site).map(|(_, part)| part).collect();
        let (path, end) = Walk::new(&course, &room, &parts, (self.range_m, self.step_m)).walked(ctx)?;
        match end {
            Ok(()) => {
                let last = path[path.len() - 1];
                let goal = course.points[course.last()];
                let complete = (goal - last).norm() <= course.tolerance_m || room.spare_m(goal) < 0.0;
                if !complete {
                    ctx.log(LogLevel::Warn, "the plan is not complete: it ends short of its end");
                }
                Ok(Plan { cost: polyline::length_m(&path), path, complete, ..Plan::default() })
            }
            Err(station) => Err(refusal::no_path(&course, (request.site, &room), station, path)),
        }
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.pursuit.step(sensed, ctx)
    }
}

#[cfg(test)]
mod tests;
