//! The navigation function.

use crate::{
    flight::Flyer,
    navigation::Navigation,
    problem::{PlanningProblem, refusal},
};
use planner_api::{
    Caps, Command, Config, Ctx, LogLevel, ParamSpec, Plan, PlanRequest, Planner, Result, Sensed, Site, int,
};
use steering::params as p;
use world::shortest::{GrownFloor, NoWay, Way};

/// Distance from a path, in cells, within which its taut version may turn about solids.
const REACH_CELLS: f64 = 4.0;

const CELLS: ParamSpec = int("cells", "Cells along the longer side", "", 20, 2000, 240)
    .help(
        "Number of cells along the longer side of the floor. More cells find narrower paths and take \
           more time.",
    )
    .group("Plan");

/// Marches from the goal over the cells of the floor, descends the field from the robot and pulls the resulting path
/// taut.
///
/// The field is kept between plans and repaired when an obstacle is discovered. If the cells show no path, the exact
/// search decides, so either the robot arrives or the planner proves that the goal cannot be reached.
pub struct Navfn {
    clearance_m: f64,
    cells: usize,
    navigation: Option<Navigation>,
    flyer: Flyer,
}

impl Planner for Navfn {
    const ID: &'static str = "navfn";
    const NAME: &'static str = "Navigation function";
    const ABOUT: &'static str = "Eikonal distance to the goal on a grid, repaired when the map changes, \
                                 and a path pulled taut. If no path exists, it proves this. Evades moving \
                                 obstacles.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] =
        &[CELLS, p::CLEARANCE, p::GUARD, p::GUARD_SIGMAS, p::SLOW, p::MIN_SHARE, p::STUCK];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        Ok(Self {
            clearance_m: config.float("clearance_m"),
            cells: config.int("cells").max(2) as usize,
            navigation: None,
            flyer: Flyer::new(p::flight(config), site),
        })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        self.clearance_m = config.float("clearance_m");
        self.cells = config.int("cells").max(2) as usize;
        self.flyer.set(p::flight(config));
        Ok(())
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let problem = PlanningProblem::new(request, self.clearance_m)?;
        let floor = problem.grown();
        self.way(&problem, &floor, ctx)
            .map(|way| problem.plan_of(&way, ctx))
            .map_err(|no_way| refusal(no_way, ctx))
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.flyer.step(sensed, ctx)
    }
}

impl Navfn {
    fn way(
        &mut self,
        problem: &PlanningProblem,
        floor: &GrownFloor,
        ctx: &Ctx<'_>,
    ) -> std::result::Result<Way, NoWay> {
        let mut keep_going = || ctx.check().is_ok();
        let navigation = match &mut self.navigation {
            Some(kept) => {
                kept.update(problem, floor, self.cells);
                kept
            }
            none => none.insert(Navigation::new(problem, floor, self.cells)),
        };
        let before = navigation.n_settled();
        let way = navigation.way(problem.start, floor, &mut keep_going);
        ctx.scalar("cells_settled", navigation.n_settled().saturating_sub(before) as f64, "");
        let reach_m = REACH_CELLS * navigation.cell_m();
        let taut = way.and_then(|way| floor.pulled_taut(&way, reach_m, &mut keep_going).ok());
        if let Some(way) = taut {
            return Ok(way);
        }
        let exact = floor.shortest(problem.start, problem.goal, &mut keep_going)?;
        let message = format!(
            "cells of {:.2} m are too coarse for the only path; the exact search found it",
            navigation.cell_m()
        );
        ctx.log(LogLevel::Info, &message);
        Ok(exact)
    }
}

#[cfg(test)]
mod tests;
