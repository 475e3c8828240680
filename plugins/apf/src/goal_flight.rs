//! What the goal planners of this crate share: checks of a plan, the map as it is known, the flight along a force.

use field::{
    Flight, Ground, Nearby, Pilot, Scene, drawing, goal_walk::Trip, law::Forces, offline, outcome::Walk,
    pilot::Tick,
};
use planner_api::{
    Code, Command, Ctx, Drive, Plan, PlanRequest, PlannerError, Result, Sensed, Site, Status, Task,
};
use world::{Point, Vector};

/// Steps allowed for a plan, as a multiple of those of the straight way, and some more for short ways.
const DETOUR: f64 = 10.0;
const SPARE_STEPS: usize = 2000;

/// A map and somebody who flies over it.
pub(crate) struct GoalFlight {
    /// The map as far as it is known.
    pub ground: Ground,
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
        let ground = Ground::new(site);
        Self { nearby: Nearby::new(reach_m + ground.hull_m), ground, flight, pilot: Pilot::pursuing(site) }
    }

    /// Takes the map of a request and checks its ends; `id` names the planner.
    ///
    /// # Errors
    /// [`Code::Unsupported`] for a preset path, and those of [`offline::check_start`] and [`offline::check_goal`].
    pub(crate) fn check(&mut self, request: &PlanRequest<'_>, id: &str, step_m: f64) -> Result<Checked> {
        let Task::Goto { goal, tolerance_m } = request.task else {
            let message = format!("{id} goes to single goals; for preset paths choose apf or rpf");
            return Err(PlannerError::new(Code::Unsupported, message));
        };
        let scene = Scene::new(request.site);
        let start = request.start.position;
        offline::check_start(&scene, start, request.site.limits.radius_m)?;
        offline::check_goal(&scene, goal, tolerance_m)?;
        self.ground = Ground::new(request.site);
        self.nearby.forget();
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
        force: impl FnOnce(Point, &Ground, &mut Nearby) -> Forces,
    ) -> Result<Command> {
        ctx.check()?;
        let bodies = self.pilot.bodies(sensed);
        if self.ground.learn(&bodies) {
            self.nearby.forget();
        }
        let at = sensed.pose.position;
        let forces = force(at, &self.ground, &mut self.nearby);
        let tick = Tick {
            t_s: sensed.t_s,
            pose: sensed.pose,
            target: sensed.target,
            is_last: sensed.targets_ahead.len() <= 1,
            bodies: &bodies,
        };
        drawing::show(ctx, at, &forces, k_att);
        let near_m = bodies.iter().map(|body| body.hull_distance_m(at, self.ground.hull_m));
        let near_m = near_m.fold(f64::INFINITY, f64::min);
        if near_m.is_finite() {
            ctx.scalar("obstacle_distance", near_m, "m");
        }
        let Some(along) = forces.resultant().try_normalize(1e-12) else {
            return Ok(Command::still(Status::Stuck));
        };
        let way: Vector = along * (sensed.target - at).norm().clamp(0.05, 1.0);
        let decision = self.pilot.pursue(&self.flight, &tick, at + way);
        Ok(Command { drive: Drive::Velocity(decision.velocity), status: decision.status })
    }
}

impl Checked {
    /// A walk as a plan; what is wrong with it is logged.
    pub(crate) fn plan_of(&self, walk: Walk, ground: &Ground, ctx: &Ctx<'_>) -> Plan {
        let clearance_m = ground.path_clearance_m(&walk.path, self.demanded_m + 1.0);
        offline::plan_of(walk, clearance_m, self.demanded_m, ctx)
    }
}
