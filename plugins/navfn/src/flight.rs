//! Flying along a plan.

use field::{Flight, Pilot, drawing, pilot::Tick};
use planner_api::{Command, Ctx, Drive, Result, Sensed, Site, Status};

/// Follows the plan, half a metre ahead, with the guard's word as the last.
pub struct Flyer {
    flight: Flight,
    pilot: Pilot,
}

impl Flyer {
    /// A flyer at a site.
    pub fn new(flight: Flight, site: &Site<'_>) -> Self {
        Self { flight, pilot: Pilot::pursuing(site) }
    }

    /// Takes over changed settings on the way.
    pub fn set(&mut self, flight: Flight) {
        self.flight = flight;
    }

    /// The velocity until the next tick; without a plan the robot waits for one.
    ///
    /// # Errors
    /// When the console wants it to stop.
    pub fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        ctx.check()?;
        let Some(&target) = sensed.path_ahead.first() else { return Ok(Command::still(Status::Waiting)) };
        let bodies = self.pilot.bodies(sensed);
        let is_last = sensed.targets_ahead.len() <= 1 && sensed.path_ahead.len() <= 1;
        let tick = Tick { t_s: sensed.t_s, pose: sensed.pose, target, is_last, bodies: &bodies };
        let decision = self.pilot.pursue(&self.flight, &tick, target);
        drawing::show(ctx, sensed.pose.position, &decision.forces, 1.0);
        Ok(Command { drive: Drive::Velocity(decision.velocity), status: decision.status })
    }
}
