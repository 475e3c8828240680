//! The tangent follower, our reactive planner for preset paths.

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

/// Minimum sensing range beyond the clearance, metres.
const LEAST_SIGHT_M: f64 = 0.5;

const RANGE: ParamSpec = float("range_m", "Sensing range", "m", 0.5, 10.0, 1.2)
    .help(
        "Obstacles further from the centre of the robot are ignored. It cannot exceed the robot's own \
         sensing range.",
    )
    .group("Plan");
const STEP: ParamSpec = float("step_m", "Longest move", "m", 0.01, 0.3, 0.1)
    .help(
        "Length of a move in the plan; with shorter moves, the path passes obstacles at a distance nearer to \
         the clearance.",
    )
    .group("Plan");

/// Follows a preset path, or a different planner's plan, according to what the robot senses.
///
/// It heads straight for the next free point. It passes obstacles along the tangent of the headings that they block, on
/// the side where it misses less floor. In a pocket, where neither side leads back to the course, it takes the shortest
/// path out, given everything sensed so far. It never enters places where hull and clearance do not fit.
pub struct SpiralTangent {
    clearance_m: f64,
    /// The hull radius and the mission's clearance, metres.
    site: (f64, f64),
    range_m: f64,
    step_m: f64,
    pursuit: Pursuit,
}

impl Planner for SpiralTangent {
    const ID: &'static str = "spiral-tangent";
    const NAME: &'static str = "Tangent follower";
    const ABOUT: &'static str = "Reactive: follows a preset path or a plan according to what the robot \
                                 senses, and passes obstacles along their tangents, with clearance and \
                                 wall as hard limits. Treats moving obstacles as stationary.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] =
        &[p::CLEARANCE, RANGE, STEP, p::GUARD, p::GUARD_SIGMAS, p::SLOW, p::MIN_SHARE, p::STUCK];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        course::check_numbers(config, Self::PARAMS)?;
        let hull_m = site.limits.radius_m;
        let range_m = config.float("range_m").min(site.limits.sensing_range_m + hull_m);
        let clearance_m = clearance_m(config, (hull_m, site.clearance_m), range_m)?;
        Ok(Self {
            clearance_m,
            site: (hull_m, site.clearance_m),
            range_m,
            step_m: config.float("step_m").max(0.005),
            pursuit: Pursuit::new(p::flight(config), clearance_m, site),
        })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        course::check_numbers(config, Self::PARAMS)?;
        self.clearance_m = clearance_m(config, self.site, self.range_m)?;
        self.pursuit.set(p::flight(config), self.clearance_m);
        Ok(())
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
                    ctx.log(
                        LogLevel::Warn,
                        "the plan is incomplete: it ends short of the end of the preset path",
                    );
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

/// The clearance that a plan keeps, metres, if the robot sees far enough for it.
fn clearance_m(config: &Config<'_>, (hull_m, demanded_m): (f64, f64), range_m: f64) -> Result<f64> {
    let clearance_m = config.float("clearance_m");
    let least_m = hull_m + clearance_m.max(demanded_m) + LEAST_SIGHT_M;
    if range_m < least_m {
        let message = format!(
            "a sensing range of {range_m:.2} m is too short for hull and clearance; it must be at \
             least {least_m:.2} m, or the clearance must be smaller"
        );
        return Err(PlannerError::new(Code::Config, message));
    }
    Ok(clearance_m)
}

#[cfg(test)]
mod tests;
