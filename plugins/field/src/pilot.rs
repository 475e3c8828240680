//! Steering a robot along a law, tick by tick, with a noisy pose and obstacles discovered on the way.

use crate::{
    body::Body,
    contact::{Contact, Source},
    drawing,
    escape::{Escape, Escaping, Situation},
    gaps::{Detour, GapSteering, View},
    guard,
    law::{Forces, Law, RotationForm},
    laws::Sense,
    scene::{no_go, wall_contacts},
    settings::{Flight, Settings, Steering},
    stall::{Remedy, Stall},
    trap::TrapDetector,
    turning::{Reading, SenseRule, Turning},
};
use geometry::convex::Part;
use planner_api::{Command, Ctx, Drive, Layer, Limits, Motion, PoseEstimate, Result, Sensed, Site, Status};
use world::{Point, Vector};

/// The guard keeps this much more than the mission demands, for it lets the hull touch its limit, metres.
const SPARE_M: f64 = 0.02;
/// Beyond this distance the pull of a target no longer grows, metres.
const FAR_M: f64 = 1.0;
/// The position error widens the guard by no more than this, metres: a robot that is lost shall still move.
const MOST_WIDENING_M: f64 = 0.15;
/// Within this distance of the last point the robot slows down, metres.
const ARRIVING_M: f64 = 0.5;
/// The way to a preset point need not be free over this last piece: the mission looks half a metre ahead, metres.
const PASSING_M: f64 = 0.35;
/// After this share of the time to being stuck, and every such share again, another remedy is tried.
const REMEDY_SHARE: f64 = 0.3;
/// How much of the last direction is kept, so that noise does not shake the robot.
const SMOOTHING: f64 = 0.5;

/// Flies a robot by a law.
///
/// The command is a velocity along the resultant at the estimated position, slowed down near obstacles and passed
/// through the guard, which is the last word.
#[derive(Debug, Clone)]
pub struct Pilot {
    limits: Limits,
    clearance_m: f64,
    wall: world::Boundary,
    no_go: Vec<Body>,
    gate: Gate,
    gaps: GapSteering,
    stall: Stall,
    remedy: Remedy,
    direction: Option<Vector>,
}

/// The situation in one tick.
#[derive(Debug, Clone, Copy)]
pub struct Tick<'a> {
    /// Mission time, seconds.
    pub t_s: f64,
    /// Where the robot believes to be.
    pub pose: PoseEstimate,
    /// Where to go next.
    pub target: Point,
    /// Whether the task ends at the target.
    pub is_last: bool,
    /// What is near, no-go zones included.
    pub bodies: &'a [Body],
}

/// How the robot moves, and why.
#[derive(Debug, Clone)]
pub struct Decision {
    /// Velocity in the tank frame, metres per second.
    pub velocity: Vector,
    /// Moving, or stuck.
    pub status: Status,
    /// The forces that led there.
    pub forces: Forces,
    /// What is gone round, if anything.
    pub detour: Option<Detour>,
}

/// The paper's gate in flight: a place is recorded whenever a move of the plan would have been over.
#[derive(Debug, Clone)]
struct Gate {
    turning: Turning,
    escaping: Escaping,
    escape: Vector,
    detector: TrapDetector,
    due_s: f64,
}

impl Pilot {
    /// A pilot for a site.
    pub fn new(settings: &Settings, site: &Site<'_>) -> Self {
        Self::with(Turning::new(settings.reading, settings.rule), settings.escape, site)
    }

    /// A pilot that only pursues aims.
    pub fn pursuing(site: &Site<'_>) -> Self {
        Self::with(Turning::new(Reading::Off, SenseRule::CounterClockwise), Escape::None, site)
    }

    fn with(turning: Turning, escape: Escape, site: &Site<'_>) -> Self {
        Self {
            limits: site.limits,
            clearance_m: site.clearance_m,
            wall: site.boundary.to_owned(),
            no_go: no_go(site).filter_map(|(id, outline)| Body::new(id, &outline)).collect(),
            gate: Gate {
                turning,
                escaping: Escaping::new(escape),
                escape: Vector::zeros(),
                detector: TrapDetector::default(),
                due_s: f64::NEG_INFINITY,
            },
            gaps: GapSteering::default(),
            stall: Stall::default(),
            remedy: Remedy::default(),
            direction: None,
        }
    }

    /// Takes over changed settings on the way; what it remembers stays.
    pub fn reset(&mut self, settings: &Settings) {
        self.gate.turning = Turning::new(settings.reading, settings.rule);
    }

    /// The velocity until the next tick, with the forces drawn.
    ///
    /// # Errors
    /// When the console wants it to stop.
    pub fn step(&mut self, settings: &Settings, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        ctx.check()?;
        let tick = Tick {
            t_s: sensed.t_s,
            pose: sensed.pose,
            target: sensed.target,
            is_last: sensed.targets_ahead.len() <= 1,
            bodies: &self.bodies(sensed),
        };
        let decision = self.decide(settings, &tick);
        drawing::show(ctx, sensed.pose.position, &decision.forces, settings.law.k_att);
        show_detour(ctx, decision.detour.as_ref());
        Ok(Command { drive: Drive::Velocity(decision.velocity), status: decision.status })
    }

    /// The same without a console: how the robot moves in this situation.
    pub fn decide(&mut self, settings: &Settings, tick: &Tick<'_>) -> Decision {
        let keep_m = self.keep_m(&settings.flight, &tick.pose);
        let idle_s = self.stall.update(tick.t_s, tick.pose.position, tick.target);
        if self.remedy.update(idle_s, settings.flight.stuck_s * REMEDY_SHARE) {
            self.gaps.flip();
        }
        let detour = self.detour(settings, tick, keep_m);
        let contacts = self.contacts(settings, tick, detour.as_ref());
        let forces = self.forces(settings, tick, &contacts, detour.as_ref());
        let wanted = self.smoothed(&forces, tick) * self.speed(&settings.flight, tick, &forces, &contacts);
        let velocity = self.guarded(wanted, tick, keep_m);
        let status = if idle_s > settings.flight.stuck_s { Status::Stuck } else { Status::Moving };
        Decision { velocity, status, forces, detour }
    }

    /// Toward an aim instead of along a law: for planners that know where to go next, not by what force.
    ///
    /// Speed, guard and the report of being stuck are those of [`Pilot::decide`].
    pub fn pursue(&mut self, flight: &Flight, tick: &Tick<'_>, aim: Point) -> Decision {
        let at = tick.pose.position;
        let idle_s = self.stall.update(tick.t_s, at, tick.target);
        if self.remedy.update(idle_s, flight.stuck_s * REMEDY_SHARE) {
            self.gaps.flip();
        }
        let forces = Forces { attraction: (aim - at).cap_magnitude(FAR_M), ..Forces::default() };
        let near = tick.bodies.iter().filter_map(|body| body.nearest_contact(at, self.limits.radius_m));
        let contacts: Vec<Contact> = near.filter(|contact| contact.distance_m < flight.slow_m).collect();
        let wanted = self.smoothed(&forces, tick) * self.speed(flight, tick, &forces, &contacts);
        let velocity = self.guarded(wanted, tick, self.keep_m(flight, &tick.pose));
        let status = if idle_s > flight.stuck_s { Status::Stuck } else { Status::Moving };
        Decision { velocity, status, forces, detour: None }
    }

    /// What the robot can do.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Radius of the hull, metres.
    pub fn hull_m(&self) -> f64 {
        self.limits.radius_m
    }

    /// What is sensed in parts, no-go zones included.
    pub fn bodies(&self, sensed: &Sensed<'_>) -> Vec<Body> {
        let near = sensed.obstacles.iter().filter_map(|o| Body::new(o.id, &o.outline));
        near.chain(self.no_go.iter().cloned()).collect()
    }

    /// Distance the guard keeps between hull and anything solid, metres.
    pub fn keep_m(&self, flight: &Flight, pose: &PoseEstimate) -> f64 {
        let widening_m = (flight.guard_sigmas * position_sigma_m(pose)).min(MOST_WIDENING_M);
        flight.guard_m.max(self.clearance_m + SPARE_M) + if widening_m.is_finite() { widening_m } else { 0.0 }
    }

    fn detour(&mut self, settings: &Settings, tick: &Tick<'_>, keep_m: f64) -> Option<Detour> {
        if settings.flight.steering == Steering::Paper { None } else { self.way_round(tick, keep_m) }
    }

    /// What blocks the way to the target, if anything, and which way round to go; another side is tried, or none, while
    /// nothing comes of it.
    pub fn way_round(&mut self, tick: &Tick<'_>, keep_m: f64) -> Option<Detour> {
        let detour = self.gaps.update(&View {
            t_s: tick.t_s,
            at: tick.pose.position,
            heading_rad: tick.pose.heading_rad,
            target: tick.target,
            near_enough_m: if tick.is_last { 0.0 } else { PASSING_M },
            bodies: tick.bodies,
            wall: &self.wall,
            hull_m: self.limits.radius_m,
            keep_m,
        });
        detour.filter(|_| !self.remedy.pushes())
    }

    /// What acts on the robot: the nearest part of every body, closed gaps of a detour, the wall.
    fn contacts(&self, settings: &Settings, tick: &Tick<'_>, detour: Option<&Detour>) -> Vec<Contact> {
        let at = tick.pose.position;
        let (law, hull_m) = (&settings.law, self.limits.radius_m);
        let mut contacts: Vec<Contact> = tick
            .bodies
            .iter()
            .filter_map(|body| body.nearest_contact(at, hull_m))
            .filter(|contact| contact.distance_m < law.rho_0_m)
            .collect();
        for &(a, b) in detour.map_or(&[][..], |detour| &detour.closed) {
            let (distance_m, away) = Part::Capsule { a, b, half_width_m: 0.0 }.distance(at);
            let contact = Contact { source: Source::Gap, distance_m: distance_m - hull_m, away };
            // A robot that already stands in the gap must get out of it either way.
            if (0.0..law.rho_0_m).contains(&contact.distance_m) {
                contacts.push(contact);
            }
        }
        if law.wall_gain > 0.0 {
            contacts.extend(wall_contacts(&self.wall, at, hull_m, law.reach_m(Source::Wall)));
        }
        contacts
    }

    fn forces(
        &mut self,
        settings: &Settings,
        tick: &Tick<'_>,
        contacts: &[Contact],
        detour: Option<&Detour>,
    ) -> Forces {
        let at = tick.pose.position;
        let goal = at + (tick.target - at).cap_magnitude(FAR_M);
        match settings.flight.steering {
            Steering::Gaps => {
                // The printed form would make the robot jerk at the range of every obstacle.
                let law = Law { rotation: RotationForm::Smooth, ..settings.law };
                unopposed(law.forces(at, goal, contacts, |c| sense_about(detour, c)))
            }
            Steering::Paper => {
                self.gate.update(settings, tick, contacts, self.limits.v_max_m_per_s);
                let mut forces = settings.law.forces(at, goal, contacts, |c| self.gate.turning.sense(c));
                forces.attraction += self.gate.escape;
                forces
            }
        }
    }

    /// The direction of the resultant, with a little of the last one.
    fn smoothed(&mut self, forces: &Forces, tick: &Tick<'_>) -> Vector {
        let toward = (tick.target - tick.pose.position).try_normalize(1e-9);
        let Some(wanted) = forces.resultant().try_normalize(1e-9).or(toward) else { return Vector::zeros() };
        let last = self.direction.unwrap_or(wanted);
        let direction = (wanted * (1.0 - SMOOTHING) + last * SMOOTHING).try_normalize(1e-3).unwrap_or(wanted);
        self.direction = Some(direction);
        direction
    }

    /// Slower toward what is near and at the end of the way.
    fn speed(&self, flight: &Flight, tick: &Tick<'_>, forces: &Forces, contacts: &[Contact]) -> f64 {
        let direction = forces.resultant().try_normalize(1e-9).unwrap_or_else(Vector::zeros);
        let near = contacts.iter().map(|contact| {
            let closing = (-contact.away.dot(&direction)).max(0.0);
            1.0 - closing * (1.0 - (contact.distance_m / flight.slow_m).clamp(0.0, 1.0))
        });
        let missing_m = (tick.target - tick.pose.position).norm();
        let arriving = if tick.is_last { missing_m / ARRIVING_M } else { 1.0 };
        let share = near.fold(1.0, f64::min).min(arriving).max(flight.min_share);
        self.limits.v_max_m_per_s * share
    }

    fn guarded(&self, wanted: Vector, tick: &Tick<'_>, keep_m: f64) -> Vector {
        let (hull_m, v_max) = (self.limits.radius_m, self.limits.v_max_m_per_s);
        let reach_m = keep_m + v_max;
        let pose = &tick.pose;
        let solid = tick.bodies.iter().flat_map(|body| body.contacts(pose.position, hull_m));
        let contacts: Vec<Contact> = solid
            .filter(|contact| contact.distance_m < reach_m)
            .chain(wall_contacts(&self.wall, pose.position, hull_m, reach_m))
            .collect();
        let safe = guard::slide(wanted, &contacts, keep_m, v_max);
        match self.limits.motion {
            Motion::Point => safe,
            Motion::Unicycle => {
                let heading = Vector::new(pose.heading_rad.cos(), pose.heading_rad.sin());
                guard::braked(safe, heading, &contacts, keep_m)
            }
        }
    }
}

impl Gate {
    fn update(&mut self, settings: &Settings, tick: &Tick<'_>, contacts: &[Contact], v_max: f64) {
        if tick.t_s < self.due_s {
            return;
        }
        let step_m = settings.walking.step_m;
        self.due_s = tick.t_s + step_m / v_max.max(1e-3);
        let to_target = tick.target - tick.pose.position;
        self.detector.record(tick.pose.position);
        let obstacle_acts = contacts.iter().any(|c| c.source != Source::Wall);
        let trapped = self.detector.is_trapped(step_m, step_m, to_target.norm(), obstacle_acts);
        self.turning.update(trapped, contacts, to_target);
        self.escape = self.escaping.update(&Situation {
            is_trapped: trapped,
            at: tick.pose.position,
            goal: tick.target,
            contacts,
            law: &settings.law,
            step_m,
        });
    }
}

/// The forces without what holds against the rotation, so that nothing stops the robot on its way round.
fn unopposed(forces: Forces) -> Forces {
    let Some(around) = forces.rotation.try_normalize(1e-9) else { return forces };
    let along = |force: Vector| force - around * force.dot(&around).min(0.0);
    Forces { attraction: along(forces.attraction), repulsion: along(forces.repulsion), ..forces }
}

fn sense_about(detour: Option<&Detour>, contact: &Contact) -> Option<Sense> {
    let detour = detour?;
    let belongs = match contact.source {
        Source::Obstacle(id) => detour.members.contains(&id),
        Source::Gap => true,
        Source::Wall => false,
    };
    belongs.then_some(detour.sense)
}

fn show_detour(ctx: &Ctx<'_>, detour: Option<&Detour>) {
    if let Some(detour) = detour.filter(|_| ctx.wants_drawing()) {
        for &(a, b) in &detour.closed {
            ctx.polyline(Layer::Virtual, &[a, b]);
        }
    }
}

/// Standard deviation of the position in the direction in which it is largest, metres.
pub fn position_sigma_m(pose: &PoseEstimate) -> f64 {
    let position = pose.covariance.fixed_view::<2, 2>(0, 0).into_owned();
    position.symmetric_eigenvalues().max().max(0.0).sqrt()
}
