//! The code shared by all potential fields on a preset path. A plan simulates a walk over the known map; during the
//! mission, the field acts tick by tick.

use crate::course;
use field::{FieldSettings, ForcePilot, offline};
use planner_api::{
    Caps, Command, Config, Ctx, ParamSpec, Plan, PlanRequest, Planner, Result, Sensed, Site, Task,
};
use std::marker::PhantomData;

/// The properties in which the potential fields differ.
pub trait Kind: 'static {
    /// The planner's id.
    const ID: &'static str;
    /// The human-readable name.
    const NAME: &'static str;
    /// One sentence about the field, including its source.
    const ABOUT: &'static str;
    /// The parameters.
    const PARAMS: &'static [ParamSpec];

    /// Converts a configuration to settings of the field.
    fn settings(config: &Config<'_>) -> FieldSettings;
}

/// A potential field as a planner.
pub struct Potential<K> {
    pub(crate) settings: FieldSettings,
    pilot: ForcePilot,
    kind: PhantomData<K>,
}

impl<K: Kind> Planner for Potential<K> {
    const ID: &'static str = K::ID;
    const NAME: &'static str = K::NAME;
    const ABOUT: &'static str = K::ABOUT;
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] = K::PARAMS;

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        course::check_numbers(config, K::PARAMS)?;
        let settings = K::settings(config);
        Ok(Self { settings, pilot: ForcePilot::new(&settings, site), kind: PhantomData })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        course::check_numbers(config, K::PARAMS)?;
        self.settings = K::settings(config);
        self.pilot.reset(&self.settings);
        Ok(())
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        if let Task::Follow { targets, .. } = request.task {
            course::check_targets(targets)?;
            course::check_pitch(request.site.limits.radius_m + request.site.clearance_m, targets)?;
        }
        offline::plan(&self.settings, request, ctx)
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        self.pilot.step(&self.settings, sensed, ctx)
    }
}
