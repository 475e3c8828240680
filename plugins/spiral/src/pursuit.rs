//! Flying along a plan or a preset path: straight to the next point, past what is in the way along its tangent.

use crate::tangent::Around;
use geometry::{Point, convex::Part};
use planner_api::{Command, Ctx, Result, Sensed, Site};
use steering::{Flight, Forces, Keep, Pilot, Tick};

/// The way is looked at this far ahead, metres.
const REACH_M: f64 = 0.4;

/// Follows a plan, or without one the preset points, with a noisy pose and obstacles discovered on the way.
pub(crate) struct Pursuit {
    flight: Flight,
    clearance_m: f64,
    pilot: Pilot,
}

impl Pursuit {
    /// A pursuit at a site that keeps this clearance, or the mission's if that is larger, metres.
    pub(crate) fn new(flight: Flight, clearance_m: f64, site: &Site<'_>) -> Self {
        Self { flight, clearance_m, pilot: Pilot::pursuing(site) }
    }

    /// Takes over changed settings on the way; what it remembers stays.
    pub(crate) fn set(&mut self, flight: Flight, clearance_m: f64) {
        (self.flight, self.clearance_m) = (flight, clearance_m);
    }

    /// The velocity until the next tick.
    ///
    /// # Errors
    /// When the console wants it to stop.
    pub(crate) fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        ctx.check()?;
        let bodies = self.pilot.bodies(sensed);
        let tick = Tick::along_path(sensed, &bodies);
        let aim = self.aim(&tick).unwrap_or(tick.target);
        let at = sensed.pose.position;
        Forces::toward(at, aim).show(ctx, at, 1.0);
        Ok(self.pilot.pursue(&self.flight, &tick, aim).into())
    }

    /// Where to head now: along the tangent of what blocks the way, if something does.
    fn aim(&mut self, tick: &Tick<'_>) -> Option<Point> {
        let at = tick.pose.position;
        let keep_m = self.pilot.keep_m(&self.flight, &tick.pose).max(self.clearance_m);
        let detour = self.pilot.way_round(tick, keep_m)?;
        let closed: Vec<Part> = detour.closed.iter().map(|(a, b)| Part::segment(*a, *b)).collect();
        let solid = tick.bodies.iter().flat_map(|body| &body.parts);
        let hull_m = self.pilot.limits().radius_m;
        let keep = Keep { obstacle_m: hull_m + keep_m, wall_m: hull_m + keep_m };
        // A robot that already stands in a closed gap must get out of it either way.
        let gaps = closed.iter().filter(|part| part.distance(at).0 >= hull_m);
        let around = Around { wall: self.pilot.wall(), parts: solid.chain(gaps).collect(), keep };
        let wanted = (tick.target - at).try_normalize(1e-9)?;
        around.tangent(at, wanted, REACH_M, detour.side).map(|heading| at + heading)
    }
}
