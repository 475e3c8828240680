//! The improved potential field with virtual goals.

use crate::goal_flight::GoalFlight;
use field::{
    GoalLaw, Sides, goal_walk, params as p,
    virtual_goals::{SquareLaw, VirtualGoals},
};
use planner_api::{
    Caps, Command, Config, Ctx, Layer, LogLevel, ParamSpec, Plan, PlanRequest, Planner, Result, Sensed, Site,
    choice, flag, float, int,
};
use steering::{Forces, KnownMap, Nearby};
use world::{Point, Vector};

/// Attraction and repulsion; in a local minimum, also a virtual goal on a square around the goal (Yang et al. 2021).
pub(crate) struct ApfVirtualGoals {
    law: Law,
    flight: GoalFlight,
    goals: VirtualGoals,
}

/// The field and its step rule.
#[derive(Debug, Clone, Copy)]
struct Law {
    square: SquareLaw,
    repulsion: GoalLaw,
    step_m: f64,
    proportional: bool,
    steps_max: usize,
}

const FIELD: &str = "Field";
const GOALS: &str = "Virtual goals";
const K_ATT: ParamSpec = float("k_att", "Attraction gain", "N/m", 0.001, 1000.0, 15.0)
    .help("Pull towards the goal per metre of distance; Table 2 of the paper has 15.")
    .group(FIELD);
const K_REP: ParamSpec = float("k_rep", "Repulsion gain", "N m3", 0.0, 1000.0, 5.0)
    .help("Gain of the push from obstacles; Table 2 of the paper has 5.")
    .group(FIELD);
const RHO_0: ParamSpec = float("rho_0_m", "Obstacle range", "m", 0.05, 50.0, 1.0)
    .help("Distance from the hull at which obstacles begin to act.")
    .group(FIELD);
const D_0: ParamSpec = float("d_0_m", "Goal range", "m", 0.0, 100.0, 3.0)
    .help("Closer to the goal than this, the pull is constant and no virtual goal is used.")
    .group(GOALS);
const SQUARE: ParamSpec = float("square_m", "Virtual goal distance", "m", 0.1, 100.0, 2.0)
    .help("Distance of the four virtual goals from the goal; the paper gives no value.")
    .group(GOALS);
const IMPROVED: ParamSpec = flag("improved", "Improved", true)
    .help("If this is off, the planner is the traditional field that the paper compares its method with.")
    .group(GOALS);
const HOLD: ParamSpec = int("hold_steps", "Virtual goal duration", "", 1, 10_000, 30)
    .help("Largest number of steps for which a virtual goal is kept; the paper gives no value.")
    .group(GOALS);
const STEP: ParamSpec = float("goto_step_m", "Step", "m", 0.001, 1.0, 0.1)
    .help("Longest step when planning; corresponds to the paper's time step of 0.1 s.")
    .group("Plan");
const STEP_RULE: ParamSpec = choice("step_rule", "Step length rule", &["fixed", "proportional"], 1)
    .help(
        "proportional: steps are shorter where the force, in newtons, is below the attraction gain. The \
         lengths of such paths are closer to those in the paper's tables.",
    )
    .group("Plan");
const STEPS: ParamSpec = int("steps_max", "Maximum steps", "", 0, 1_000_000, 0)
    .help("Largest number of steps in a plan; the paper has 200. 0: derived from the length of the trip.")
    .group("Plan");

impl Planner for ApfVirtualGoals {
    const ID: &'static str = "apf-virtual-goals";
    const NAME: &'static str = "Field with virtual goals";
    const ABOUT: &'static str = "Leaves local minima towards virtual goals on a square around the goal and \
                                 keeps its pull near the goal, after Yang et al. 2021. Evades moving \
                                 obstacles.";
    const CAPS: Caps = Caps::GLOBAL.and(Caps::LOCAL).and(Caps::LIVE_PARAMS);
    const PARAMS: &'static [ParamSpec] = &[
        K_ATT,
        K_REP,
        RHO_0,
        D_0,
        SQUARE,
        IMPROVED,
        HOLD,
        p::WALL_GAIN,
        STEP,
        STEP_RULE,
        STEPS,
        p::GUARD,
        p::GUARD_SIGMAS,
        p::SLOW,
        p::MIN_SHARE,
        p::STUCK,
        p::EVADE,
    ];

    fn configure(config: &Config<'_>, site: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        let law = law(config);
        let flight = GoalFlight::new(site, config, law.repulsion.rho_m);
        Ok(Self { law, flight, goals: VirtualGoals::default() })
    }

    fn reconfigure(&mut self, config: &Config<'_>, _: &Ctx<'_>) -> Result<()> {
        self.law = law(config);
        self.flight.set(config);
        Ok(())
    }

    fn plan(&mut self, request: &PlanRequest<'_>, ctx: &Ctx<'_>) -> Result<Plan> {
        let mut checked = self.flight.check(request, Self::ID, self.law.step_m)?;
        let law = self.law;
        if law.steps_max > 0 {
            checked.trip.steps_max = law.steps_max;
        }
        let trip = checked.trip;
        let (map, mut nearby) = (&self.flight.map, self.flight.nearby.clone());
        let mut goals = VirtualGoals::default();
        let next = |at: Point| {
            let missing_m = (trip.goal - at).norm();
            if missing_m <= law.step_m {
                return Some(trip.goal - at);
            }
            let force = law.forces(at, trip.goal, map, &mut nearby, &mut goals).resultant();
            Some(force.try_normalize(1e-12).unwrap_or_else(Vector::zeros) * law.move_m(force))
        };
        let walk = goal_walk::walk(&trip, next, || ctx.check())?;
        if goals.used > 0 {
            ctx.log(LogLevel::Info, &format!("number of virtual goals that the path uses: {}", goals.used));
        }
        ctx.scalar("virtual_goals", f64::from(goals.used), "");
        let instead = format!(
            "virtual goals {:.1} m from the goal (square_m) lead out of single local minima, but not \
             around the {} parts of this map: choose shortest or navfn, which find a path wherever one \
             exists",
            law.square.square_m,
            map.solids.len(),
        );
        Ok(checked.plan_of(walk, map, &instead, ctx))
    }

    fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        let (law, goals) = (self.law, &mut self.goals);
        let used = goals.used;
        let command = self.flight.step(sensed, ctx, law.square.k_att, |at, map, nearby| {
            law.forces(at, sensed.target, map, nearby, goals)
        })?;
        if self.goals.used > used {
            ctx.log(LogLevel::Debug, "in a local minimum: heading for a virtual goal");
        }
        if let Some(corner) = self.goals.current() {
            ctx.circle(Layer::Virtual, corner, 0.2);
        }
        ctx.scalar("virtual_goals", f64::from(self.goals.used), "");
        Ok(command)
    }
}

impl Law {
    /// The forces at a position. In a local minimum, a virtual goal is chosen first.
    fn forces(
        &self,
        at: Point,
        goal: Point,
        map: &KnownMap,
        nearby: &mut Nearby,
        goals: &mut VirtualGoals,
    ) -> Forces {
        let forces = self.repulsion.forces(at, goal, map, nearby, &mut Sides::default());
        let push = forces.repulsion;
        let without = self.square.attraction(at, goal, None) + push;
        if goals.needs_one(&self.square, at, goal, without, self.step_m) {
            goals.take_best(&self.square, at, goal, push, map);
        }
        Forces { attraction: self.square.attraction(at, goal, goals.current()), ..forces }
    }

    fn move_m(&self, force: Vector) -> f64 {
        let share = if self.proportional { (force.norm() / self.square.k_att).min(1.0) } else { 1.0 };
        self.step_m * share
    }
}

fn law(config: &Config<'_>) -> Law {
    let square = SquareLaw {
        k_att: config.float("k_att"),
        d_0_m: config.float("d_0_m"),
        square_m: config.float("square_m"),
        improved: config.flag("improved"),
        hold_steps: config.int("hold_steps") as usize,
    };
    Law {
        square,
        repulsion: square.push(config.float("k_rep"), config.float("rho_0_m"), config.float("wall_gain")),
        step_m: config.float("goto_step_m"),
        proportional: config.choice("step_rule") == "proportional",
        steps_max: config.int("steps_max") as usize,
    }
}

#[cfg(test)]
mod tests;
