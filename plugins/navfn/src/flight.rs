//! Flying along a plan.

use planner_api::{Command, Ctx, Result, Sensed, Site, Status};
use steering::{Flight, Forces, Pilot, Tick, evade};

/// Follows the plan, aiming half a metre ahead. Moving obstacles are evaded, and every velocity passes the guard last.
pub(crate) struct Flyer {
    flight: Flight,
    pilot: Pilot,
}

impl Flyer {
    /// Creates a flyer for a site.
    pub(crate) fn new(flight: Flight, site: &Site<'_>) -> Self {
        Self { flight, pilot: Pilot::pursuing(site) }
    }

    /// Applies changed settings during the flight.
    pub(crate) fn set(&mut self, flight: Flight) {
        self.flight = flight;
    }

    /// Returns the command for one tick. Without a plan, the robot waits for one.
    ///
    /// # Errors
    /// The console requests a stop.
    pub(crate) fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        ctx.check()?;
        if sensed.path_ahead.is_empty() {
            return Ok(Command::still(Status::Waiting));
        }
        let (movers, standing) = evade::sorted(sensed, self.pilot.bodies(sensed));
        let (tick, at) = (Tick::along_path(sensed, &standing), sensed.pose.position);
        Forces::toward(at, tick.target).show(ctx, at, 1.0);
        let decision = self.pilot.pursue(&self.flight, &tick, tick.target);
        Ok(self.pilot.past(&movers, decision, &tick, ctx))
    }
}
