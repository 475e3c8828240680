//! The offset lattice, our global planner for preset paths.

use crate::{
    course::{self, Course},
    lattice::{self, Blocked, Limits},
    pursuit::Pursuit,
    refusal,
};
use planner_api::{
    Caps, Command, Config, Ctx, LogLevel, ParamSpec, Plan, PlanRequest, Planner, Result, Sensed, Site, float,
};
use steering::{Room, params as p};
use world::polyline;

const TURN: ParamSpec = float("turn_deg", "Turn limit per 0.2 m", "deg", 0.0, 180.0, 30.0)
    .help(
        "Largest change of heading along 0.2 m of path, except where the preset path itself turns more \
         sharply; 0: no limit.",
    )
    .group("Plan")
    .live();
const MAX_OFFSET: ParamSpec = float("max_offset_m", "Largest offset", "m", 0.1, 5.0, 1.25)
    .help(
        "How far from the preset path to search for a way round at first; if there is none, the search \
         extends twice as far.",
    )
    .group("Plan")
    .live();

/// Plans along a preset path: where the path is free, the plan stays on it; elsewhere, the plan passes beside it at the
/// lowest cost.
///
/// Clearance, wall and change of heading are hard limits of the search. During the mission, the robot follows the plan
/// with the guard active; obstacles found on the way are bypassed with a new plan.
pub struct SpiralLattice {
    wishes: Wishes,
    pursuit: Pursuit,
}

/// The settings for plans.
#[derive(Debug, Clone, Copy)]
struct Wishes {
    clearance_m: f64,
    limits: Limits,
}

impl Planner for SpiralLattice {
    const ID: &'static str = "spiral-lattice";
    const NAME: &'static str = "Offset lattice";
    const ABOUT: &'static str = "Global plan along a preset path by dynamic programming: smallest squared \
                                 offset, with clearance, wall and turn limit as hard limits. Treats moving \
                                 obstacles as stationary.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] =
        &[p::CLEARANCE, TURN, MAX_OFFSET, p::GUARD, p::GUARD_SIGMAS, p::SLOW, p::MIN_SHARE, p::STUCK];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        let wishes = wishes(config)?;
        Ok(Self { wishes, pursuit: Pursuit::new(p::flight(config), wishes.clearance_m, site) })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        self.wishes = wishes(config)?;
        self.pursuit.set(p::flight(config), self.wishes.clearance_m);
        Ok(())
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let course = Course::new(request)?;
        let room = course::room(request.site, self.wishes.clearance_m, &course)?;
        course::check_start(request, &course, &room, ctx)?;
        match lattice::plan(&course, &room, self.wishes.limits, ctx)? {
            Ok(path) => Ok(plan_of(path, &course, &room, ctx)),
            Err(Blocked { station, partial }) => {
                Err(refusal::no_path(&course, (request.site, &room), station, partial))
            }
        }
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.pursuit.step(sensed, ctx)
    }
}

fn wishes(config: &Config<'_>) -> Result<Wishes> {
    course::check_numbers(config, SpiralLattice::PARAMS)?;
    let turn_deg = config.float("turn_deg");
    let turn_per_m = if turn_deg > 0.0 { turn_deg.to_radians() / 0.2 } else { f64::INFINITY };
    let offset_m = config.float("max_offset_m");
    let limits = Limits { offset_m, turn_per_m };
    Ok(Wishes { clearance_m: config.float("clearance_m"), limits })
}

fn plan_of(path: lattice::Path, course: &Course, room: &Room, ctx: &Ctx<'_>) -> Plan {
    for window in &path.sharp {
        let (from, to) = (course.points[*window.start()], course.points[*window.end()]);
        ctx.log(
            LogLevel::Warn,
            &format!(
                "between ({:.2}, {:.2}) and ({:.2}, {:.2}), the only possible path exceeds the turn limit",
                from.x, from.y, to.x, to.y
            ),
        );
    }
    let (start, begin) = (course.points[0], path.points[0]);
    if (begin - start).norm() > 1e-6 && room.spare_m(start) >= 0.0 {
        let beside_m = (begin - start).norm();
        ctx.log(
            LogLevel::Warn,
            &format!(
                "no path continues from the start along the preset path; the plan begins {beside_m:.2} m \
                 away from the start"
            ),
        );
    }
    let end = path.points[path.points.len() - 1];
    let goal = course.points[course.last()];
    let missing_m = (goal - end).norm();
    let complete = missing_m <= course.tolerance_m || room.spare_m(goal) < 0.0;
    if !complete {
        ctx.log(
            LogLevel::Warn,
            &format!("the plan is incomplete: it ends {missing_m:.2} m short of the end of the preset path"),
        );
    }
    Plan { cost: polyline::length_m(&path.points), path: path.points, complete, ..Plan::default() }
}

#[cfg(test)]
mod tests;
