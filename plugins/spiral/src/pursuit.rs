//! Follows a plan or a preset path during the mission: straight to the next point, and past anything in the way along
//! its tangent.

use crate::tangent::Around;
use geometry::{Point, convex::Part};
use planner_api::{Command, Ctx, Result, Sensed, Site};
use steering::{Flight, Forces, Keep, Pilot, Tick};

/// Distance ahead within which the robot checks whether its way is free, metres.
const REACH_M: f64 = 0.4;

/// Follows a plan, or the preset points if there is no plan, with a noisy pose and obstacles found during the mission.
pub(crate) struct Pursuit {
    flight: Flight,
    clearance_m: f64,
    pilot: Pilot,
}

impl Pursuit {
    /// Creates a pursuit that keeps this clearance, metres, or the mission's clearance if that is larger.
    pub(crate) fn new(flight: Flight, clearance_m: f64, site: &Site<'_>) -> Self {
        Self { flight, clearance_m, pilot: Pilot::pursuing(site) }
    }

    /// Changes the settings during a mission; everything else stays as it is.
    pub(crate) fn set(&mut self, flight: Flight, clearance_m: f64) {
        (self.flight, self.clearance_m) = (flight, clearance_m);
    }

    /// Returns the velocity until the next tick.
    ///
    /// # Errors
    /// The console asked to stop.
    pub(crate) fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        ctx.check()?;
        let bodies = self.pilot.bodies(sensed);
        let tick = Tick::along_path(sensed, &bodies);
        let aim = self.aim(&tick).unwrap_or(tick.target);
        let at = sensed.pose.position;
        Forces::toward(at, aim).show(ctx, at, 1.0);
        Ok(self.pilot.pursue(&self.flight, &tick, aim).into())
    }

    /// If something is in the way, returns the point to aim at now, along the tangent of the obstacle.
    fn aim(&mut self, tick: &Tick<'_>) -> Option<Point> {
        let at = tick.pose.position;
        let keep_m = self.pilot.keep_m(&self.flight, &tick.pose).max(self.clearance_m);
        let detour = self.pilot.way_round(tick, keep_m)?;
        let closed: Vec<Part> = detour.closed.iter().map(|(a, b)| Part::segment(*a, *b)).collect();
        let solid = tick.bodies.iter().flat_map(|body| &body.parts);
        let hull_m = self.pilot.limits().radius_m;
        let keep = Keep { obstacle_m: hull_m + keep_m, wall_m: hull_m + keep_m };
        // A robot that is already inside a closed gap must be able to leave it on either side.
        let gaps = closed.iter().filter(|part| part.distance(at).0 >= hull_m);
        let around = Around { wall: self.pilot.wall(), parts: solid.chain(gaps).collect(), keep };
        let wanted = (tick.target - at).try_normalize(1e-9)?;
        around.tangent(at, wanted, REACH_M, detour.side).map(|heading| at + heading)
    }
}
