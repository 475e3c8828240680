//! What the goal planners of this crate share: checks of a plan, the map as it is known, the flight along a force.

use field::{ends, goal_walk::Trip, outcome::Walk};
use planner_api::{Command, Ctx, Plan, PlanRequest, Result, Sensed, Site, Status};
use steering::{Flight, Forces, KnownMap, Nearby, Pilot, Tick, drawing};
use world::{Point, Vector};

/// Steps allowed for a plan, as a multiple of those of the straight way, and some more for short ways.
const DETOUR: f64 = 10.0;
const SPARE_STEPS: usize = 2000;

/// A map and somebody who flies over it.
pub(crate) struct GoalFlight {
    /// The map as far as it is known.
    pub map: KnownMap,
    /// What of it is near the robot.
    pub nearby: Nearby,
    flight: Flight,
    pilot: Pilot,
}

/// A plan's task, checked.
pub(crate) struct Checked {
    /// From where to where.
    pub trip: Trip,
    demanded_m: f64,
}

impl GoalFlight {
    /// A flight over a site, for a law that reaches so far.
    pub(crate) fn new(site: &Site<'_>, flight: Flight, reach_m: f64) -> Self {
        let map = KnownMap::new(site);
        Self { nearby: Nearby::new(reach_m + map.hull_m), map, flight, pilot: Pilot::pursuing(site) }
    }

    /// Takes the map of a request and checks its ends; `id` names the planner.
    ///
    /// # Errors
    /// Those of [`ends::single_goal`].
    pub(crate) fn check(&mut self, request: &PlanRequest<'_>, id: &str, step_m: f64) -> Result<Checked> {
        let (goal, tolerance_m) = ends::single_goal(request, id)?;
        self.map = KnownMap::new(request.site);
        self.nearby.forget();
        let start = request.start.position;
        let steps_max = (DETOUR * (goal - start).norm() / step_m) as usize + SPARE_STEPS;
        let trip = Trip { start, goal, tolerance_m, steps_max };
        Ok(Checked { trip, demanded_m: request.site.clearance_m })
    }

    /// Takes what is sensed, and flies along the force that `force` gives for the place and the map.
    ///
    /// # Errors
    /// When the console wants it to stop.
    pub(crate) fn step(
        &mut self,
        sensed: &Sensed<'_>,
        ctx: &Ctx<'_>,
        k_att: f64,
        force: impl FnOnce(Point, &KnownMap, &mut Nearby) -> Forces,
    ) -> Result<Command> {
        ctx.check()?;
        let bodies = self.pilot.bodies(sensed);
        if self.map.learn(&bodies) {
            self.nearby.forget();
        }
        let at = sensed.pose.position;
        let forces = force(at, &self.map, &mut self.nearby);
        forces.show(ctx, at, k_att);
        drawing::show_nearest(ctx, at, self.map.hull_m, &bodies);
        let Some(along) = forces.resultant().try_normalize(1e-12) else {
            return Ok(Command::still(Status::Stuck));
        };
        let way: Vector = along * (sensed.target - at).norm().clamp(0.05, 1.0);
        Ok(self.pilot.pursue(&self.flight, &Tick::toward_target(sensed, &bodies), at + way).into())
    }
}

impl Checked {
    /// A walk as a plan; what is wrong with it is logged, and what to do `instead`.
    pub(crate) fn plan_of(&self, walk: Walk, map: &KnownMap, instead: &str, ctx: &Ctx<'_>) -> Plan {
        let clearance_m = map.path_clearance_m(&walk.path, self.demanded_m + 1.0);
        walk.into_plan_or(clearance_m, self.demanded_m, instead, ctx)
    }
}
