//! The tangent field.

use crate::goal_flight::GoalFlight;
use field::{GoalLaw, Pull, Sides, TangentUse, goal_walk, open_points as o, params as p};
use planner_api::{
    Caps, Command, Config, Ctx, ParamSpec, Plan, PlanRequest, Planner, Result, Sensed, Site, choice, float,
};

/// Attraction, repulsion and a force along the tangent of obstacles: the method with which Xu et al. 2022 compare their
/// own.
///
/// It passes single obstacles in the way; in a trap it stops and reports that it is stuck.
pub(crate) struct Tapf {
    law: GoalLaw,
    step_m: f64,
    window_m: f64,
    flight: GoalFlight,
    sides: Sides,
}

const FIELD: &str = "Field";
const K_REP: ParamSpec = float("k_rep", "Repulsion gain", "N m3", 0.0, 1000.0, 10.0)
    .help("Gain of the push and the tangent force from obstacles; mu in the paper.")
    .group(FIELD);
const RHO_0: ParamSpec = float("rho_0_m", "Obstacle range", "m", 0.05, 50.0, 2.0)
    .help("Distance from the hull at which obstacles begin to act.")
    .group(FIELD);
const TANGENT: ParamSpec = choice("tangent", "Tangent force", &["off", "always", "blocking"], 2)
    .help(
        "always: towards the left tangent of every obstacle in range. With a weight of 0.02 and an \
         obstacle of 1 m radius, or with a weight of 1 and a radius of 3.2 to 3.55 m (both fitted), the \
         robot stops where the paper says. blocking: around whatever blocks the path to the goal. off: \
         the classical field.",
    )
    .group(FIELD);
const WEIGHT: ParamSpec = float("tangent_weight", "Tangent force weight", "", 0.0, 100.0, 1.0)
    .help("Tangent force as a multiple of the repulsion gain.")
    .group(FIELD);
/// The wall's share of the repulsion gain: 1/500 of the share used by the other planners, because this planner's gain
/// is much larger. With their share, the wall would push the robot away from goals a metre from the wall.
const WALL: ParamSpec = float("wall_gain", "Wall repulsion", "", 0.0, 10.0, 0.001)
    .help(
        "Push from the wall within half the obstacle range, as a share of the repulsion gain. 0: none, as \
         in the paper, which has no wall.",
    )
    .group(FIELD)
    .live();
const STEP: ParamSpec = float("goto_step_m", "Step", "m", 0.001, 1.0, 0.05)
    .help("Length of a step when planning; the paper gives no value.")
    .group("Plan");
const WINDOW: ParamSpec = float("window_m", "Oscillation window", "m", 0.1, 50.0, 2.0)
    .help(
        "The planned path counts as trapped when its last steps, which together have this length, make \
         almost no headway.",
    )
    .group("Plan");

impl Planner for Tapf {
    const ID: &'static str = "tapf";
    const NAME: &'static str = "Tangent potential field";
    const ABOUT: &'static str = "Attraction, repulsion and a tangent force, after Xu et al. 2022. Gets \
                                 stuck in half-closed traps. Evades moving obstacles.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] = &[
        p::K_ATT,
        K_REP,
        RHO_0,
        o::GOAL_PUSH_FORM,
        TANGENT,
        WEIGHT,
        WALL,
        STEP,
        WINDOW,
        p::GUARD,
        p::GUARD_SIGMAS,
        p::SLOW,
        p::MIN_SHARE,
        p::STUCK,
        p::EVADE,
    ];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        let law = law(config);
        Ok(Self {
            law,
            step_m: config.float("goto_step_m"),
            window_m: config.float("window_m"),
            flight: GoalFlight::new(site, config, law.rho_m),
            sides: Sides::default(),
        })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        self.law = law(config);
        self.flight.set(config);
        Ok(())
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let checked = self.flight.check(request, Self::ID, self.step_m)?;
        let (law, trip) = (self.law, checked.trip);
        let (map, mut nearby) = (&self.flight.map, self.flight.nearby.clone());
        let mut sides = Sides::default();
        let force = |at| law.forces(at, trip.goal, map, &mut nearby, &mut sides).resultant();
        let next = goal_walk::descent(&trip, self.step_m, self.window_m, force);
        let walk = goal_walk::walk(&trip, next, || ctx.check())?;
        Ok(checked.plan_of(walk, map, "choose shortest or navfn, which find a path wherever one exists", ctx))
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        let (law, sides) = (self.law, &mut self.sides);
        let k_att = law.pull.strength(1.0);
        self.flight
            .step(sensed, ctx, k_att, |at, map, nearby| law.forces(at, sensed.target, map, nearby, sides))
    }
}

fn law(config: &Config<'_>) -> GoalLaw {
    GoalLaw {
        pull: Pull::Linear { k: config.float("k_att") },
        k_rep: config.float("k_rep"),
        push: o::goal_push_form(config),
        rho_m: config.float("rho_0_m"),
        tangent: match config.choice("tangent") {
            "off" => TangentUse::Off,
            "always" => TangentUse::Always,
            _ => TangentUse::Blocking,
        },
        tangent_weight: config.float("tangent_weight"),
        wall_gain: config.float("wall_gain"),
    }
}

#[cfg(test)]
mod tests;
