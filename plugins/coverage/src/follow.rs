//! Flying a plan: straight along it, slower where it bends, and never across a cut.

use field::{Flight, Pilot, params as p, part::crossing, pilot::Tick, scene::wall_of};
use planner_api::{Command, Config, Ctx, Drive, LogLevel, ParamSpec, Point2, Result, Sensed, Site, Status};
use world::{Boundary, Point, polyline};

/// How far ahead on the path the robot aims, metres.
const LOOK_M: f64 = 0.25;
/// The path is looked at this far for obstacles, metres.
const WATCH_M: f64 = 1.0;
/// Steering parameters that every coverage planner has.
pub const PARAMS: [ParamSpec; 5] = [p::GUARD, p::GUARD_SIGMAS, p::SLOW, p::MIN_SHARE, p::STUCK];

/// Follows the path ahead; stops in front of what was discovered on it, so that the mission plans anew.
pub struct Follow {
    flight: Flight,
    pilot: Pilot,
    wall: Boundary,
    keep_m: f64,
    cuts: Vec<Vec<Point2<f64>>>,
    has_told: bool,
}

impl Follow {
    /// A follower for a site.
    pub fn new(config: &Config<'_>, site: &Site<'_>) -> Self {
        Self {
            flight: p::flight(config),
            pilot: Pilot::pursuing(site),
            wall: wall_of(&site.boundary),
            keep_m: site.limits.radius_m,
            cuts: Vec::new(),
            has_told: false,
        }
    }

    /// Takes over the cuts of a new plan.
    pub fn keep_off(&mut self, cuts: &[Vec<Point2<f64>>]) {
        self.cuts = cuts.to_vec();
        self.has_told = false;
    }

    /// The velocity until the next tick.
    ///
    /// # Errors
    /// When the console wants it to stop.
    pub fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        ctx.check()?;
        let at = sensed.pose.position;
        let bodies = self.pilot.bodies(sensed);
        let is_blocked = |p: &Point| {
            self.wall.wall_distance_m(*p) < self.keep_m
                || bodies
                    .iter()
                    .any(|body| body.contacts(*p, 0.0).any(|contact| contact.distance_m < self.keep_m))
        };
        let way: Vec<Point> = std::iter::once(at).chain(sensed.path_ahead.iter().copied()).collect();
        let near = polyline::resampled(&within(&way, WATCH_M), 0.1);
        // Where the robot stands it stands, however near.
        if near.iter().skip(1).filter(|p| (*p - at).norm() > 0.2).any(is_blocked) {
            return Ok(self.stopped(ctx, "an obstacle stands on the path; the plan has to be made anew"));
        }
        let target = aim(at, sensed);
        if self.cuts.iter().flat_map(|cut| cut.windows(2)).any(|w| crossing(at, target, w[0], w[1]).is_some())
        {
            return Ok(self
                .stopped(ctx, "the way back to the path leads across a cut; the plan has to be made anew"));
        }
        let is_last = sensed.targets_ahead.len() <= 1 && sensed.path_ahead.len() <= 1;
        let tick = Tick { t_s: sensed.t_s, pose: sensed.pose, target, is_last, bodies: &bodies };
        let decision = self.pilot.pursue(&self.flight, &tick, target);
        Ok(Command { drive: Drive::Velocity(decision.velocity), status: decision.status })
    }

    fn stopped(&mut self, ctx: &Ctx<'_>, why: &str) -> Command {
        if !std::mem::replace(&mut self.has_told, true) {
            ctx.log(LogLevel::Warn, why);
        }
        Command::still(Status::Stuck)
    }
}

/// The first metres of a way.
fn within(way: &[Point], most_m: f64) -> Vec<Point> {
    let mut kept = vec![way[0]];
    let mut length_m = 0.0;
    for pair in way.windows(2) {
        length_m += (pair[1] - pair[0]).norm();
        kept.push(pair[1]);
        if length_m > most_m {
            break;
        }
    }
    kept
}

/// The point of the path that is a little ahead; a corner is driven to before it is turned.
fn aim(at: Point, sensed: &Sensed<'_>) -> Point {
    let Some(first) = sensed.path_ahead.first() else { return sensed.target };
    let mut aim = *first;
    for pair in sensed.path_ahead.windows(2) {
        if (aim - at).norm() > LOOK_M {
            break;
        }
        let (to_corner, beyond) = (pair[0] - at, pair[1] - pair[0]);
        let is_corner = to_corner.norm() > 0.05 && to_corner.normalize().dot(&beyond.normalize()) < 0.7;
        if is_corner {
            break;
        }
        aim = pair[1];
    }
    aim
}
