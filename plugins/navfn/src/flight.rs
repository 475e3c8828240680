//! Flying along a plan.

use planner_api::{Command, Ctx, Drive, Layer, Result, Sensed, Site, Status};
use steering::{
    Flight, Forces, Pilot, Tick,
    evade::{self, Around},
};

/// Follows the plan, half a metre ahead, with the guard's word as the last; what moves is evaded.
pub(crate) struct Flyer {
    flight: Flight,
    pilot: Pilot,
    clearance_m: f64,
}

impl Flyer {
    /// A flyer at a site.
    pub(crate) fn new(flight: Flight, site: &Site<'_>) -> Self {
        Self { flight, pilot: Pilot::pursuing(site), clearance_m: site.clearance_m }
    }

    /// Takes over changed settings on the way.
    pub(crate) fn set(&mut self, flight: Flight) {
        self.flight = flight;
    }

    /// The velocity until the next tick; without a plan the robot waits for one.
    ///
    /// # Errors
    /// When the console wants it to stop.
    pub(crate) fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        ctx.check()?;
        if sensed.path_ahead.is_empty() {
            return Ok(Command::still(Status::Waiting));
        }
        let (movers, standing) = evade::sorted(sensed, self.pilot.bodies(sensed));
        let (tick, at) = (Tick::along_path(sensed, &standing), sensed.pose.position);
        Forces::toward(at, tick.target).show(ctx, at, 1.0);
        let decision = self.pilot.pursue(&self.flight, &tick, tick.target);
        if movers.is_empty() {
            return Ok(decision.into());
        }
        for mover in &movers {
            ctx.arrow(Layer::Virtual, mover.body.center(), mover.velocity);
        }
        let around = Around {
            movers: &movers,
            standing: &standing,
            wall: self.pilot.wall(),
            limits: self.pilot.limits(),
            clearance_m: self.clearance_m,
        };
        let velocity = evade::evade(decision.velocity, &sensed.pose, &around);
        Ok(Command { drive: Drive::Velocity(velocity), status: Status::Moving })
    }
}
