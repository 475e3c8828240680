//! The classical artificial potential field.

use field::{FieldSettings, ForcePilot, offline, params as p};
use planner_api::{Caps, Command, Config, Ctx, ParamSpec, Plan, PlanRequest, Planner, Result, Sensed, Site};

/// Attraction and repulsion after Khatib 1986, both towards a goal and along a preset path.
///
/// It cannot escape from a local minimum, and reports when it is in one.
pub struct Apf {
    settings: FieldSettings,
    pilot: ForcePilot,
}

impl Planner for Apf {
    const ID: &'static str = "apf";
    const NAME: &'static str = "Artificial potential field";
    const ABOUT: &'static str = "Attraction and repulsion after Khatib 1986, towards a goal or along a \
                                 preset path. Gets stuck in local minima. Evades moving obstacles.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] = &[
        p::K_ATT,
        p::K_REP,
        p::RHO_0,
        p::REPULSION_CLASSIC,
        p::EXPONENT,
        p::WALL_GAIN,
        p::STEP,
        p::GOTO_STEP,
        p::FLEXIBLE,
        p::TURN_LIMIT,
        p::MAX_LAG,
        p::GUARD,
        p::GUARD_SIGMAS,
        p::SLOW,
        p::MIN_SHARE,
        p::STUCK,
        p::EVADE,
    ];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        let settings = p::settings(config);
        Ok(Self { settings, pilot: ForcePilot::new(&settings, site) })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        self.settings = p::settings(config);
        self.pilot.reset(&self.settings);
        Ok(())
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        offline::plan(&self.settings, request, ctx)
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.pilot.step(&self.settings, sensed, ctx)
    }
}

#[cfg(test)]
mod tests;
