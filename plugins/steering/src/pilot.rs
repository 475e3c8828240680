//! Driving a robot, tick by tick, with a noisy pose and obstacles discovered on the way.

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

/// The guard keeps this much more than the mission demands, for it lets the hull touch its limit, metres.
const SPARE_M: f64 = 0.02;
/// The position error widens the guard by no more than this, metres: a robot that is lost shall still move.
const MOST_WIDENING_M: f64 = 0.15;
/// A guard that leaves less than this share of the speed wanted has wedged the robot.
const WEDGED_SHARE: f64 = 0.05;
/// Within this distance of the last point the robot slows down, metres.
const ARRIVING_M: f64 = 0.5;
/// After this share of the time to being stuck, and every such share again, another remedy is tried.
const REMEDY_SHARE: f64 = 0.3;
/// A robot goes no further than this between two commands, metres: it aims a little ahead.
const TICK_MOST_M: f64 = 0.1;
/// Share of the turn rate that an arc to the aim may take; the rest is for corrections.
const TURN_SHARE: f64 = 0.9;
/// Nearer aims make the arc no tighter, metres.
const LEAST_REACH_M: f64 = 0.15;
/// How much of the last direction is kept, so that noise does not shake the robot.
const SMOOTHING: f64 = 0.5;

/// Drives a robot where a planner wants it.
///
/// The command is a velocity along the wanted direction at the estimated position, slowed down near obstacles and
/// passed through the guard, which is the last word.
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

/// How the robot moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decision {
    /// Velocity in the tank frame, metres per second.
    pub velocity: Vector,
    /// Moving, or stuck.
    pub status: Status,
}

impl From<Decision> for Command {
    fn from(decision: Decision) -> Self {
        Self { drive: Drive::Velocity(decision.velocity), status: decision.status }
    }
}

impl Pilot {
    /// A pilot for a site.
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

    /// Straight toward an aim.
    pub fn pursue(&mut self, flight: &Flight, tick: &Tick<'_>, aim: Point) -> Decision {
        let status = self.watch(flight, tick);
        let at = tick.pose.position;
        let near = tick.bodies.iter().filter_map(|body| body.nearest_contact(at, self.limits.radius_m));
        let contacts: Vec<Contact> = near.filter(|contact| contact.distance_m < flight.slow_m).collect();
        let wanted = Forces::toward(at, aim).resultant();
        Decision { velocity: self.velocity(flight, tick, wanted, &contacts), status }
    }

    /// Whether the robot gets on, asked once a tick, first; if it does not, another way round is tried.
    pub fn watch(&mut self, flight: &Flight, tick: &Tick<'_>) -> Status {
        let idle_s = self.stall.update(tick.t_s, tick.pose.position, tick.target);
        if self.remedy.update(idle_s, flight.stuck_s * REMEDY_SHARE) {
            self.detours.flip();
        }
        if idle_s > flight.stuck_s { Status::Stuck } else { Status::Moving }
    }

    /// What blocks the way to the target, if anything, and which way round to go; another side is tried, or none, while
    /// nothing comes of it.
    pub fn way_round(&mut self, tick: &Tick<'_>, keep_m: f64) -> Option<Detour> {
        let view = View { tick, wall: &self.wall, hull_m: self.limits.radius_m, keep_m };
        self.detours.update(&view).filter(|_| !self.remedy.pushes())
    }

    /// The velocity along a direction, of any length, at a speed that what is near allows.
    pub fn velocity(&mut self, flight: &Flight, tick: &Tick<'_>, wanted: Vector, near: &[Contact]) -> Vector {
        let along = wanted.try_normalize(1e-9);
        let speed = self.speed(flight, tick, along.unwrap_or_else(Vector::zeros), near);
        let direction = self.smoothed(along, tick);
        let velocity = direction * speed.min(self.turning_speed(direction, tick));
        let keep_m = self.keep_m(flight, &tick.pose);
        let spare_m = flight.guard_m.max(self.clearance_m + SPARE_M) - self.clearance_m;
        let safe = self.guarded(velocity, tick, keep_m);
        // Wedged where the plan, which keeps the mission's clearance, passes.
        let is_wedged = safe.norm() < WEDGED_SHARE * velocity.norm();
        if is_wedged { self.guarded(velocity, tick, keep_m - spare_m) } else { safe }
    }

    /// The command for a decision, or for the velocity nearest to it that stays clear of what moves; the bodies of the
    /// tick are what stands.
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

    /// What the robot can do.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// The wall.
    pub fn wall(&self) -> &Boundary {
        &self.wall
    }

    /// What is sensed in parts, no-go zones included.
    pub fn bodies(&self, sensed: &Sensed<'_>) -> Vec<Body> {
        Body::sensed(sensed, &self.no_go)
    }

    /// Distance the guard keeps between hull and anything solid, metres.
    pub fn keep_m(&self, flight: &Flight, pose: &PoseEstimate) -> f64 {
        let widening_m = (flight.guard_sigmas * position_sigma_m(pose)).min(MOST_WIDENING_M);
        flight.guard_m.max(self.clearance_m + SPARE_M) + if widening_m.is_finite() { widening_m } else { 0.0 }
    }

    /// The direction wanted, or that to the target without one, with a little of the last one.
    fn smoothed(&mut self, wanted: Option<Vector>, tick: &Tick<'_>) -> Vector {
        let toward = (tick.target - tick.pose.position).try_normalize(1e-9);
        let Some(wanted) = wanted.or(toward) else { return Vector::zeros() };
        let last = self.direction.unwrap_or(wanted);
        let direction = (wanted * (1.0 - SMOOTHING) + last * SMOOTHING).try_normalize(1e-3).unwrap_or(wanted);
        self.direction = Some(direction);
        direction
    }

    /// Slower toward what is near and at the end of the way.
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

    /// The largest speed in a direction from which a robot with a heading comes round to the target, metres per second.
    fn turning_speed(&self, direction: Vector, tick: &Tick<'_>) -> f64 {
        if self.limits.motion == Motion::Point {
            return f64::INFINITY;
        }
        let off_rad = heading_error_rad(direction, tick.pose.heading_rad).abs();
        let reach_m = (tick.target - tick.pose.position).norm().max(LEAST_REACH_M);
        // Of the speed only the part along the heading is driven.
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

/// Standard deviation of the position in the direction in which it is largest, metres.
pub fn position_sigma_m(pose: &PoseEstimate) -> f64 {
    let position = pose.covariance.fixed_view::<2, 2>(0, 0).into_owned();
    position.symmetric_eigenvalues().max().max(0.0).sqrt()
}
