//! Follows a plan: straight along it, slower at bends, and never across a cut.
//!
//! Lanes end at cuts, so position noise occasionally makes the robot appear slightly beyond a cut. The tether is not
//! wound round anything as long as the robot returns the way it came. So the line back to the path may cross a cut, as
//! long as it ends on the same side of the cut as the path.

mod steer;

use crate::workspace::Workspace;
use planner_api::{
    Command, Config, Ctx, Drive, LegTag, LogLevel, Motion, Plan, Result, Sensed, Site, Status,
};
use steering::{Flight, Pilot, Tick, params as p, pilot::position_sigma_m};
use world::{Boundary, Point, polyline, tether::crossings};

/// Distance along the path to the point at which the robot aims, metres.
const LOOK_M: f64 = 0.25;
/// Distance ahead within which the path is checked for obstacles, metres.
const WATCH_M: f64 = 1.0;
/// Number of standard deviations of the position by which an obstacle may come closer to the path than the required
/// distance before it counts as blocking the path.
const PATH_SIGMAS: f64 = 2.0;
/// Distance within which the robot counts as having reached the point from which the cuts apply, metres.
const THERE_M: f64 = 0.3;
/// Largest share of the mission's clearance that the guard maintains. A path is planned with the full clearance; a
/// guard that maintained all of it would push the robot off lanes beside walls and columns.
const GUARD_SHARE: f64 = 0.75;
/// Distance that a pilot adds to the clearance, metres.
const PILOT_SPARE_M: f64 = 0.02;

/// Follows the path. Stops in front of obstacles discovered on it, so that the mission replans.
pub(crate) struct Follow {
    flight: Flight,
    /// The mission's clearance, metres.
    clearance_m: f64,
    pilot: Pilot,
    wall: Boundary,
    keep_m: f64,
    cuts: Vec<Cut>,
    /// The point on the path from which the cuts apply; `None` once the robot has reached it.
    from: Option<Point>,
    seen_at: Option<Point>,
    has_reported: bool,
}

/// A line that the path does not cross.
struct Cut {
    line: Vec<Point>,
    /// Whether the robot has crossed to the other side.
    is_beyond: bool,
}

impl Cut {
    /// Whether a straight move ends on the other side of the line from where it began.
    fn is_crossed(&self, from: Point, to: Point) -> bool {
        crossings(&[from, to], std::slice::from_ref(&self.line)) % 2 == 1
    }
}

impl Follow {
    /// Creates a follower for a site.
    pub(crate) fn new(config: &Config<'_>, site: &Site<'_>) -> Self {
        let flight = flight(config, site.clearance_m);
        let clearance_m = flight.guard_m - PILOT_SPARE_M;
        Self {
            flight,
            clearance_m: site.clearance_m,
            pilot: Pilot::pursuing(&Site { clearance_m, ..*site }),
            wall: site.boundary.to_owned(),
            keep_m: site.limits.radius_m,
            cuts: Vec::new(),
            from: None,
            seen_at: None,
            has_reported: false,
        }
    }

    /// Applies new values of the live parameters; the plan, its cuts and the progress along it stay.
    pub(crate) fn set(&mut self, config: &Config<'_>) {
        self.flight = flight(config, self.clearance_m);
        self.pilot.keep_clear(self.flight.guard_m - PILOT_SPARE_M);
    }

    /// Adopts the cuts of a new plan. If the plan begins with a return path, they apply from the end of that path.
    pub(crate) fn take(&mut self, plan: &Plan, workspace: &Workspace) {
        let cut = |line: &Vec<Point>| Cut { line: workspace.rooted(line), is_beyond: false };
        self.cuts = plan.cuts.iter().map(cut).collect();
        let return_path = plan.legs.first().filter(|leg| leg.tag == LegTag::Retract);
        self.from = plan.path.get(return_path.map_or(0, |leg| leg.last)).copied();
        self.seen_at = None;
        self.has_reported = false;
    }

    /// Updates, for every cut, the side on which the robot is.
    fn look(&mut self, at: Point) {
        let before = self.seen_at.replace(at);
        if self.from.is_some_and(|from| (at - from).norm() > THERE_M) {
            return;
        }
        // On the way to that point, the cuts did not apply.
        let Some(before) = before.filter(|_| self.from.is_none()) else {
            self.from = None;
            return;
        };
        for cut in &mut self.cuts {
            cut.is_beyond ^= cut.is_crossed(before, at);
        }
    }

    /// Whether a straight move ends on the path's side of every cut.
    fn comes_right(&self, at: Point, target: Point) -> bool {
        self.from.is_some() || self.cuts.iter().all(|cut| cut.is_beyond == cut.is_crossed(at, target))
    }

    /// Returns the command for one tick.
    pub(crate) fn step(&mut self, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        ctx.check()?;
        let at = sensed.pose.position;
        self.look(at);
        let bodies = self.pilot.bodies(sensed);
        // Obstacles are sensed relative to the robot, so an error in its position shifts the path relative to them.
        let off_m = (PATH_SIGMAS * position_sigma_m(&sensed.pose)).min(0.5 * self.keep_m);
        let is_blocked = |p: &Point| {
            let too_near_m = self.keep_m - off_m;
            self.wall.wall_distance_m(*p) < self.keep_m
                || bodies.iter().any(|body| body.contacts(*p, 0.0).any(|c| c.distance_m < too_near_m))
        };
        let way: Vec<Point> = std::iter::once(at).chain(sensed.path_ahead.iter().copied()).collect();
        let n_near = polyline::stations_m(&way).partition_point(|station_m| *station_m <= WATCH_M) + 1;
        let near = polyline::resampled(&way[..n_near.min(way.len())], 0.1);
        // The robot's own position is not checked, however close it is to an obstacle.
        if near.iter().skip(1).filter(|p| (*p - at).norm() > 0.2).any(is_blocked) {
            return Ok(self.stopped(ctx, "an obstacle blocks the path; replanning is required"));
        }
        let wanted = aim(at, sensed);
        let nearer = sensed.path_ahead.first().copied();
        let Some(target) = std::iter::once(wanted).chain(nearer).find(|aim| self.comes_right(at, *aim))
        else {
            return Ok(self.stopped(ctx, "the way back to the path crosses a cut; replanning is required"));
        };
        let is_last = sensed.targets_ahead.len() <= 1 && sensed.path_ahead.len() <= 1;
        let tick = Tick { t_s: sensed.t_s, pose: sensed.pose, target, is_last, bodies: &bodies };
        let decision = self.pilot.pursue(&self.flight, &tick, target);
        let wanted =
            decision.velocity.cap_magnitude(steer::speed_ahead(at, sensed.path_ahead, self.pilot.limits()));
        let limits = self.pilot.limits();
        let drive = match limits.motion {
            Motion::Unicycle => steer::twist(wanted, sensed.pose.heading_rad, (target - at).norm(), limits),
            Motion::Point => Drive::Velocity(wanted),
        };
        Ok(Command { drive, status: decision.status })
    }

    fn stopped(&mut self, ctx: &Ctx<'_>, why: &str) -> Command {
        if !std::mem::replace(&mut self.has_reported, true) {
            ctx.log(LogLevel::Warn, why);
        }
        Command::still(Status::Stuck)
    }
}

/// The flight settings, with the guard limited to its share of the mission's clearance, metres.
fn flight(config: &Config<'_>, clearance_m: f64) -> Flight {
    let flight = p::flight(config);
    Flight { guard_m: flight.guard_m.min(GUARD_SHARE * clearance_m), ..flight }
}

/// The point to aim at, slightly ahead on the path; at corners the robot drives to the corner before turning.
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

#[cfg(test)]
mod tests;
