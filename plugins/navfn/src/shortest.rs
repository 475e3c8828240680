//! The exact shortest path.

use crate::{
    flight::Flyer,
    problem::{PlanningProblem, refusal},
};
use planner_api::{Caps, Command, Config, Ctx, ParamSpec, Plan, PlanRequest, Planner, Result, Sensed, Site};
use steering::params as p;

/// The shortest path that hull and clearance allow on the known map, made of tangents and arcs. It is replanned
/// whenever an obstacle is discovered.
pub struct Shortest {
    clearance_m: f64,
    flyer: Flyer,
}

impl Planner for Shortest {
    const ID: &'static str = "shortest";
    const NAME: &'static str = "Exact shortest path";
    const ABOUT: &'static str = "Exact shortest path among discs and polygons, by a bitangent visibility \
                                 graph and A*. Reports when no path exists. Evades moving obstacles.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] =
        &[p::CLEARANCE, p::GUARD, p::GUARD_SIGMAS, p::SLOW, p::MIN_SHARE, p::STUCK];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        Ok(Self { clearance_m: config.float("clearance_m"), flyer: Flyer::new(p::flight(config), site) })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        self.clearance_m = config.float("clearance_m");
        self.flyer.set(p::flight(config));
        Ok(())
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let problem = PlanningProblem::new(request, self.clearance_m)?;
        let way = problem.grown().shortest(problem.start, problem.goal, &mut || ctx.check().is_ok());
        way.map(|way| problem.plan_of(&way, ctx)).map_err(|no_way| refusal(no_way, ctx))
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.flyer.step(sensed, ctx)
    }
}

#[cfg(test)]
mod tests;
