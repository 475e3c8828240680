//! Code shared by the goal planners of this crate: checks of a request, the known map, and flight along a force.

use field::{ends, goal_walk::Trip, outcome::Walk, params};
use planner_api::{Command, Config, Ctx, Plan, PlanRequest, Result, Sensed, Site, Status};
use steering::{Decision, Flight, Forces, KnownMap, Nearby, Pilot, Tick, drawing, evade};
use world::{Point, Vector};

/// Maximum number of steps in a plan: a multiple of the number needed for the straight path, plus a constant for short
/// paths.
const DETOUR: f64 = 10.0;
const SPARE_STEPS: usize = 2000;

/// A map, and a pilot that flies the robot over it.
pub(crate) struct GoalFlight {
    /// The map as known so far.
    pub map: KnownMap,
    /// The parts of the map near the robot.
    pub nearby: Nearby,
    flight: Flight,
    evades: bool,
    pilot: Pilot,
}

/// A checked task for a plan.
pub(crate) struct Checked {
    /// The start and the goal.
    pub trip: Trip,
    demanded_m: f64,
}

impl GoalFlight {
    /// Creates a flight over a site, with the configured parameters. `reach_m` is the largest distance from the hull at
    /// which an obstacle acts on the robot.
    pub(crate) fn new(site: &Site<'_>, config: &Config<'_>, reach_m: f64) -> Self {
        let evades = config.flag("evade");
        let map = map_of(site, evades);
        let (flight, pilot) = (params::flight(config), Pilot::pursuing(site));
        Self { nearby: Nearby::new(reach_m + map.hull_m), map, flight, evades, pilot }
    }

    /// Applies new values of the live parameters. The map is kept; a change to `evade` affects it only from the next
    /// plan on.
    pub(crate) fn set(&mut self, config: &Config<'_>) {
        self.flight = params::flight(config);
        self.evades = config.flag("evade");
    }

    /// Loads the map of a request and checks start and goal. `id` names the planner in messages.
    ///
    /// # Errors
    /// Those of [`ends::single_goal`].
    pub(crate) fn check(&mut self, request: &PlanRequest<'_>, id: &str, step_m: f64) -> Result<Checked> {
        let (goal, tolerance_m) = ends::single_goal(request, id)?;
        self.map = map_of(request.site, self.evades);
        self.nearby.forget();
        let start = request.start.position;
        let steps_max = (DETOUR * (goal - start).norm() / step_m) as usize + SPARE_STEPS;
        let trip = Trip { start, goal, tolerance_m, steps_max };
        Ok(Checked { trip, demanded_m: request.site.clearance_m })
    }

    /// Updates the map with the sensed obstacles, then flies along the force that `force` returns for the position and
    /// the map.
    ///
    /// # Errors
    /// The console requests a stop.
    pub(crate) fn step(
        &mut self,
        sensed: &Sensed<'_>,
        ctx: &Ctx<'_>,
        k_att: f64,
        force: impl FnOnce(Point, &KnownMap, &mut Nearby) -> Forces,
    ) -> Result<Command> {
        ctx.check()?;
        let (movers, standing) = evade::sorted_if(self.evades, sensed, self.pilot.bodies(sensed));
        // A moving obstacle appears stationary when it is first seen, and was added to the map then.
        let forgot = self.map.forget(&movers.iter().map(|mover| mover.body.id).collect::<Vec<_>>());
        if self.map.learn(&standing) || forgot {
            self.nearby.forget();
        }
        let at = sensed.pose.position;
        let forces = force(at, &self.map, &mut self.nearby);
        forces.show(ctx, at, k_att);
        drawing::show_nearest(ctx, at, self.map.hull_m, &standing);
        let tick = Tick::toward_target(sensed, &standing);
        let decision = forces.resultant().try_normalize(1e-12).map(|along| {
            let way = along * (sensed.target - at).norm().clamp(0.05, 1.0);
            self.pilot.pursue(&self.flight, &tick, at + way)
        });
        let stuck = Decision { velocity: Vector::zeros(), status: Status::Stuck };
        Ok(self.pilot.past(&movers, decision.unwrap_or(stuck), &tick, ctx))
    }
}

/// The map of a site, without obstacles that are evaded in flight.
fn map_of(site: &Site<'_>, evades: bool) -> KnownMap {
    if evades { KnownMap::standing(site) } else { KnownMap::new(site) }
}

impl Checked {
    /// Turns a walk into a plan. If the plan is not complete, logs the reason, followed by the advice `instead`.
    pub(crate) fn plan_of(&self, walk: Walk, map: &KnownMap, instead: &str, ctx: &Ctx<'_>) -> Plan {
        let clearance_m = map.path_clearance_m(&walk.path, self.demanded_m + 1.0);
        walk.into_plan_or(clearance_m, self.demanded_m, instead, ctx)
    }
}
