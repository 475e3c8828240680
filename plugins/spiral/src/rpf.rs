//! The rotating potential field.

use field::{Pilot, Settings, offline, params as p};
use planner_api::{Caps, Command, Config, Ctx, ParamSpec, Plan, PlanRequest, Planner, Result, Sensed, Site};

/// The rotating potential field of Wang et al. 2023, in both readings.
///
/// For a point robot planning walks the law in lock step as the paper does; for one with a hull that fails nearly
/// always, so there the known map is flown in thought. In flight the rotating force is, unless set otherwise, used
/// about whatever blocks the way and on the side of the smaller detour: as printed it gets stuck.
pub struct Rpf {
    settings: Settings,
    pilot: Pilot,
}

impl Planner for Rpf {
    const ID: &'static str = "rpf";
    const NAME: &'static str = "Rotating potential field";
    const ABOUT: &'static str = "Potential field with a rotating force about obstacles, along a preset spiral, after \
                                 Wang et al. 2023.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] = &[
        p::READING,
        p::SENSE,
        p::ROTATION,
        p::K_ATT,
        p::K_REP,
        p::K_ROT,
        p::RHO_0,
        p::REPULSION_IMPROVED,
        p::EXPONENT,
        p::WALL_GAIN,
        p::PLANNING,
        p::STEP,
        p::GOTO_STEP,
        p::FLEXIBLE,
        p::TURN_LIMIT,
        p::MAX_LAG,
        p::STEERING,
        p::GUARD,
        p::GUARD_SIGMAS,
        p::SLOW,
        p::MIN_SHARE,
        p::STUCK,
    ];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        let settings = p::rotating_settings(config);
        Ok(Self { settings, pilot: Pilot::new(&settings, site) })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        self.settings = p::rotating_settings(config);
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
