//! Drives a robot tick by tick, with a noisy pose and obstacles discovered on the way.

use crate::{
    blockage::View,
    body::Body,
    contact::{Contact, wall_contacts},
    detour::{Detour, Detours},
    drawing::Forces,
    evade::{self, Around, Mover},
    guard,
    params::Flight,
    stall::{Remedy, Stall},
    tick::Tick,
};
use geometry::{Boundary, Braking, Limits, Motion, Point, Vector, motion::heading_error_rad};
use planner_api::{Command, Ctx, Drive, PoseEstimate, Sensed, Site, Status};

/// Distance that the guard adds to the mission's clearance, metres, because the guard lets the hull go right to its
/// limit.
const SPARE_M: f64 = 0.02;
/// Maximum widening of the guard distance because of the position error, metres, so that a lost robot can still move.
const MOST_WIDENING_M: f64 = 0.15;
/// Share of the desired speed below which the robot counts as wedged by the guard.
const WEDGED_SHARE: f64 = 0.05;
/// Distance from the last point within which the robot slows down, metres.
const ARRIVING_M: f64 = 0.5;
/// Interval between remedies, as a share of the time after which the robot is considered stuck.
const REMEDY_SHARE: f64 = 0.3;
/// Longest distance that the robot drives between two commands, metres: it aims only slightly ahead.
const TICK_MOST_M: f64 = 0.1;
/// Share of the turn rate that an arc to the target may use; the rest is for corrections.
const TURN_SHARE: f64 = 0.9;
/// Distance to the target below which the arc does not get any tighter, metres.
const LEAST_REACH_M: f64 = 0.15;
/// Weight of the previous direction, so that noise does not shake the robot.
const SMOOTHING: f64 = 0.5;

/// Drives a robot in the direction that a planner wants.
///
/// The command is a velocity in the desired direction from the estimated position. It is slowed down near obstacles and
/// passes the guard last.
#[derive(Debug, Clone)]
pub struct Pilot {
    limits: Limits,
    clearance_m: f64,
    wall: Boundary,
    no_go: Vec<Body>,
    detours: Detours,
    stall: Stall,
    remedy: Remedy,
    direction: Option<Vector>,
}

/// The motion chosen for a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decision {
    /// Velocity in the tank frame, metres per second.
    pub velocity: Vector,
    /// Moving or stuck.
    pub status: Status,
}

impl From<Decision> for Command {
    fn from(decision: Decision) -> Self {
        Self { drive: Drive::Velocity(decision.velocity), status: decision.status }
    }
}

impl Pilot {
    /// Creates a pilot for a site.
    pub fn pursuing(site: &Site<'_>) -> Self {
        Self {
            limits: site.limits,
            clearance_m: site.clearance_m,
            wall: site.boundary.to_owned(),
            no_go: Body::no_go(site),
            detours: Detours::default(),
            stall: Stall::default(),
            remedy: Remedy::default(),
            direction: None,
        }
    }

    /// Drives straight towards a target.
    pub fn pursue(&mut self, flight: &Flight, tick: &Tick<'_>, aim: Point) -> Decision {
        let status = self.watch(flight, tick);
        let at = tick.pose.position;
        let near = tick.bodies.iter().filter_map(|body| body.nearest_contact(at, self.limits.radius_m));
        let contacts: Vec<Contact> = near.filter(|contact| contact.distance_m < flight.slow_m).collect();
        let wanted = Forces::toward(at, aim).resultant();
        Decision { velocity: self.velocity(flight, tick, wanted, &contacts), status }
    }

    /// Checks whether the robot makes progress, and tries another way around if it does not. Call this first in every
    /// tick.
    pub fn watch(&mut self, flight: &Flight, tick: &Tick<'_>) -> Status {
        let idle_s = self.stall.update(tick.t_s, tick.pose.position, tick.target);
        if self.remedy.update(idle_s, flight.stuck_s * REMEDY_SHARE) {
            self.detours.flip();
        }
        if idle_s > flight.stuck_s { Status::Stuck } else { Status::Moving }
    }

    /// Returns what blocks the path to the target, if anything, and the side on which to pass it. While the robot makes
    /// no progress, the other side is tried, then no detour.
    pub fn way_round(&mut self, tick: &Tick<'_>, keep_m: f64) -> Option<Detour> {
        let view = View { tick, wall: &self.wall, hull_m: self.limits.radius_m, keep_m };
        self.detours.update(&view).filter(|_| !self.remedy.pushes())
    }

    /// Returns the velocity along a direction, at a speed that nearby solids allow. The length of `wanted` is ignored.
    pub fn velocity(&mut self, flight: &Flight, tick: &Tick<'_>, wanted: Vector, near: &[Contact]) -> Vector {
        let along = wanted.try_normalize(1e-9);
        let speed = self.speed(flight, tick, along.unwrap_or_else(Vector::zeros), near);
        let direction = self.smoothed(along, tick);
        let velocity = direction * speed.min(self.turning_speed(direction, tick));
        let keep_m = self.keep_m(flight, &tick.pose);
        let spare_m = flight.guard_m.max(self.clearance_m + SPARE_M) - self.clearance_m;
        let safe = self.guarded(velocity, tick, keep_m);
        // The guard may have wedged the robot where the plan, which keeps only the mission's clearance, can pass.
        let is_wedged = safe.norm() < WEDGED_SHARE * velocity.norm();
        if is_wedged { self.guarded(velocity, tick, keep_m - spare_m) } else { safe }
    }

    /// Returns the command for a decision, or the closest velocity that stays clear of moving obstacles. The bodies in
    /// `tick` are treated as stationary.
    pub fn past(&self, movers: &[Mover], decision: Decision, tick: &Tick<'_>, ctx: &Ctx<'_>) -> Command {
        if movers.is_empty() {
            return decision.into();
        }
        for mover in movers {
            mover.show(ctx);
        }
        let around = Around {
            movers,
            standing: tick.bodies,
            wall: &self.wall,
            limits: &self.limits,
            clearance_m: self.clearance_m,
        };
        Command::velocity(evade::evade(decision.velocity, &tick.pose, &around))
    }

    /// Changes the mission's clearance that the guard keeps, metres; everything else stays as it is.
    pub fn keep_clear(&mut self, clearance_m: f64) {
        self.clearance_m = clearance_m;
    }

    /// The motion limits of the robot.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// The wall.
    pub fn wall(&self) -> &Boundary {
        &self.wall
    }

    /// The sensed obstacles and the no-go zones, divided into parts.
    pub fn bodies(&self, sensed: &Sensed<'_>) -> Vec<Body> {
        Body::sensed(sensed, &self.no_go)
    }

    /// The distance that the guard keeps between the hull and any solid, metres.
    pub fn keep_m(&self, flight: &Flight, pose: &PoseEstimate) -> f64 {
        let widening_m = (flight.guard_sigmas * position_sigma_m(pose)).min(MOST_WIDENING_M);
        flight.guard_m.max(self.clearance_m + SPARE_M) + if widening_m.is_finite() { widening_m } else { 0.0 }
    }

    /// The desired direction, or the direction to the target if there is none, smoothed with the previous direction.
    fn smoothed(&mut self, wanted: Option<Vector>, tick: &Tick<'_>) -> Vector {
        let toward = (tick.target - tick.pose.position).try_normalize(1e-9);
        let Some(wanted) = wanted.or(toward) else { return Vector::zeros() };
        let last = self.direction.unwrap_or(wanted);
        let direction = (wanted * (1.0 - SMOOTHING) + last * SMOOTHING).try_normalize(1e-3).unwrap_or(wanted);
        self.direction = Some(direction);
        direction
    }

    /// The speed, reduced near solids and at the end of the path.
    fn speed(&self, flight: &Flight, tick: &Tick<'_>, direction: Vector, near: &[Contact]) -> f64 {
        let near = near.iter().map(|contact| {
            let closing = (-contact.away.dot(&direction)).max(0.0);
            1.0 - closing * (1.0 - (contact.distance_m / flight.slow_m).clamp(0.0, 1.0))
        });
        let missing_m = (tick.target - tick.pose.position).norm();
        let arriving = if tick.is_last { missing_m / ARRIVING_M } else { 1.0 };
        let share = near.fold(1.0, f64::min).min(arriving).max(flight.min_share);
        let braking = Braking::of(&self.limits);
        let arrived = if tick.is_last { braking.speed_within(missing_m) } else { f64::INFINITY };
        let least = flight.min_share * self.limits.v_max_m_per_s;
        let stops = arrived.min(braking.speed_within(self.limits.sensing_range_m)).max(least);
        (self.limits.v_max_m_per_s * share).min(stops).min(TICK_MOST_M / self.limits.tick_s.max(1e-3))
    }

    /// The maximum speed at which a robot moving in this direction can still turn to the target, metres per second.
    fn turning_speed(&self, direction: Vector, tick: &Tick<'_>) -> f64 {
        if self.limits.motion == Motion::Point {
            return f64::INFINITY;
        }
        let off_rad = heading_error_rad(direction, tick.pose.heading_rad).abs();
        let reach_m = (tick.target - tick.pose.position).norm().max(LEAST_REACH_M);
        // Only the component along the heading is driven.
        let bend = 2.0 * off_rad.sin() * off_rad.cos() / reach_m;
        if bend > 1e-9 { TURN_SHARE * self.limits.w_max_rad_per_s / bend } else { f64::INFINITY }
    }

    fn guarded(&self, wanted: Vector, tick: &Tick<'_>, keep_m: f64) -> Vector {
        let (hull_m, v_max) = (self.limits.radius_m, self.limits.v_max_m_per_s);
        let braking = Braking::of(&self.limits);
        let reach_m = keep_m + v_max.max(braking.distance_m(v_max).min(self.limits.sensing_range_m));
        let pose = &tick.pose;
        let solid = tick.bodies.iter().flat_map(|body| body.contacts(pose.position, hull_m));
        let contacts: Vec<Contact> = solid
            .filter(|contact| contact.distance_m < reach_m)
            .chain(wall_contacts(&self.wall, pose.position, hull_m, reach_m))
            .collect();
        let safe = guard::slide(wanted, &contacts, keep_m, v_max, &braking);
        match self.limits.motion {
            Motion::Point => safe,
            Motion::Unicycle => {
                let heading = Vector::new(pose.heading_rad.cos(), pose.heading_rad.sin());
                guard::braked(safe, heading, &contacts, keep_m, &braking)
            }
        }
    }
}

/// The largest standard deviation of the position over all directions, metres.
pub fn position_sigma_m(pose: &PoseEstimate) -> f64 {
    let position = pose.covariance.fixed_view::<2, 2>(0, 0).into_owned();
    position.symmetric_eigenvalues().max().max(0.0).sqrt()
}
