//! Flying along a plan.

use crate::evade::{self, Around, Mover};
use field::{Flight, Pilot, body::Body, drawing, pilot::Tick};
use planner_api::{Command, Ctx, Drive, Layer, Limits, Result, Sensed, Site, Status};
use world::Boundary;

/// Follows the plan, half a metre ahead, with the guard's word as the last; what moves is evaded.
pub(crate) struct Flyer {
    flight: Flight,
    pilot: Pilot,
    limits: Limits,
    wall: Boundary,
    clearance_m: f64,
}

impl Flyer {
    /// A flyer at a site.
    pub(crate) fn new(flight: Flight, site: &Site<'_>) -> Self {
        Self {
            flight,
            pilot: Pilot::pursuing(site),
            limits: site.limits,
            wall: site.boundary.to_owned(),
            clearance_m: site.clearance_m,
        }
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
        let Some(&target) = sensed.path_ahead.first() else { return Ok(Command::still(Status::Waiting)) };
        let (movers, standing) = self.sorted(sensed);
        let is_last = sensed.targets_ahead.len() <= 1 && sensed.path_ahead.len() <= 1;
        let tick = Tick { t_s: sensed.t_s, pose: sensed.pose, target, is_last, bodies: &standing };
        let decision = self.pilot.pursue(&self.flight, &tick, target);
        drawing::show(ctx, sensed.pose.position, &decision.forces, 1.0);
        if movers.is_empty() {
            return Ok(Command { drive: Drive::Velocity(decision.velocity), status: decision.status });
        }
        for mover in &movers {
            ctx.arrow(Layer::Virtual, mover.body.center(), mover.velocity);
        }
        let around = Around {
            movers: &movers,
            standing: &standing,
            wall: &self.wall,
            limits: &self.limits,
            clearance_m: self.clearance_m,
        };
        let velocity = evade::evade(decision.velocity, &sensed.pose, &around);
        Ok(Command { drive: Drive::Velocity(velocity), status: Status::Moving })
    }

    /// What is sensed: what moves, and what stands, no-go zones included.
    fn sorted(&self, sensed: &Sensed<'_>) -> (Vec<Mover>, Vec<Body>) {
        let of = |id: u32| sensed.obstacles.iter().find(|o| o.id == id && evade::moves(o));
        let mut movers = Vec::new();
        let mut standing = Vec::new();
        for body in self.pilot.bodies(sensed) {
            match of(body.id) {
                Some(obstacle) => movers.push(Mover { body, velocity: obstacle.velocity_m_per_s }),
                None => standing.push(body),
            }
        }
        (movers, standing)
    }
}
