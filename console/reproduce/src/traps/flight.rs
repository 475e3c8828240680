//! A flight on a map that is discovered on the way, over the plugin boundary.

use super::{
    Method,
    measured::{Gone, TOLERANCE_M},
};
use crate::{planners::Planners, study::Problem};
use mission::Cause;
use nalgebra::Matrix3;
use planner_api::{
    Drive, Obstacle, Outline, PlanRequest, PoseEstimate, Reason, Sensed, Site, Status, Task, Vector2,
};
use planner_host::BlockingHost;
use std::time::Instant;
use trials::traps::{HULL_M, STEP_M, Trap};
use world::{Point, polyline};

/// The planner is given what lies ahead on its plan, from this far on, metres.
const AHEAD_M: f64 = 0.5;
/// So much of it, metres.
const SHOWN_M: f64 = 4.0;
/// The plan is searched this far ahead for the place where the robot is, metres.
const WINDOW_M: f64 = 1.5;
/// A flight ends after so many times the moves of the straight way.
const PATIENCE: f64 = 30.0;
/// It ends, too, when the planner says so many times in a row that it is stuck.
const MOST_STUCK: u32 = 600;

/// A point robot on its way: moves of 0.05 m at most, one each tick.
struct Journey<'a> {
    trap: &'a Trap,
    all: Vec<Obstacle<'static>>,
    seen: Vec<bool>,
    known: Vec<Obstacle<'static>>,
    range_m: f64,
    flown: Vec<Point>,
    plan: Course,
    plan_times_ms: Vec<f64>,
}

/// Flies from start to goal.
///
/// # Errors
/// The planner is missing, refuses its parameters or breaks down.
pub(super) fn fly(planners: &Planners, method: &Method, trap: &Trap, range_m: f64) -> Result<Gone, Problem> {
    let all = trap.obstacles(true);
    let mut journey = Journey {
        trap,
        seen: vec![false; all.len()],
        all,
        known: Vec::new(),
        range_m,
        flown: vec![trap.start],
        plan: Course::default(),
        plan_times_ms: Vec::new(),
    };
    journey.look();
    let corners = Trap::corners();
    let mut host =
        planners.seat(method.planner, &method.parameters, &Trap::site(&corners, &journey.known, range_m))?;
    journey.ask_for_plan(&mut host, &Reason::Start, method)?;
    let most = (PATIENCE * (trap.goal - trap.start).norm() / STEP_M) as u64;
    let mut n_stuck = 0;
    for tick in 0..most {
        if (trap.goal - journey.here()).norm() <= TOLERANCE_M || n_stuck > MOST_STUCK {
            break;
        }
        if journey.look() {
            journey.ask_for_plan(&mut host, &Reason::MapChanged, method)?;
        }
        let status = journey.step(&mut host, tick, method)?;
        n_stuck = if status == Status::Moving { 0 } else { n_stuck + 1 };
    }
    Ok(Gone { path: journey.flown, plan_times_ms: journey.plan_times_ms })
}

impl Journey<'_> {
    fn here(&self) -> Point {
        self.flown[self.flown.len() - 1]
    }

    fn pose(&self) -> PoseEstimate {
        PoseEstimate { position: self.here(), heading_rad: 0.0, covariance: Matrix3::zeros() }
    }

    /// Discovers what is within range; whether anything is new.
    fn look(&mut self) -> bool {
        let (here, before) = (self.here(), self.known.len());
        for (index, (center, radius_m)) in self.trap.discs.iter().enumerate() {
            if !self.seen[index] && (center - here).norm() - radius_m <= self.range_m {
                self.seen[index] = true;
                self.known.push(self.all[index]);
            }
        }
        self.known.len() > before
    }

    fn ask_for_plan(
        &mut self,
        host: &mut BlockingHost,
        reason: &Reason,
        method: &Method,
    ) -> Result<(), Problem> {
        let corners = Trap::corners();
        let revision = self.known.len() as u32;
        let site = Site { revision, ..Trap::site(&corners, &self.known, self.range_m) };
        let task = Task::Goto { goal: self.trap.goal, tolerance_m: TOLERANCE_M };
        let request = PlanRequest { reason, start: self.pose(), task, site: &site, previous: &self.flown };
        let asked = Instant::now();
        let answer = host.plan(&request);
        self.plan_times_ms.push(asked.elapsed().as_secs_f64() * 1e3);
        match answer {
            Ok(reply) => self.plan = Course::new(&reply.value.path),
            // A planner that finds no plan may still know how to move.
            Err(fault) if matches!(fault.cause, Cause::Planner(_)) => self.plan = Course::default(),
            Err(fault) => {
                return Err(Problem::Planner { case: method.id.to_owned(), fault: Box::new(fault) });
            }
        }
        Ok(())
    }

    fn step(&mut self, host: &mut BlockingHost, tick: u64, method: &Method) -> Result<Status, Problem> {
        let here = self.here();
        self.plan.advance(here);
        let near: Vec<Obstacle<'static>> =
            self.known.iter().filter(|obstacle| self.is_in_range(obstacle)).copied().collect();
        let goal = self.trap.goal;
        let sensed = Sensed {
            tick,
            t_s: tick as f64 * STEP_M,
            dt_s: STEP_M,
            pose: self.pose(),
            v_m_per_s: 0.0,
            w_rad_per_s: 0.0,
            target: goal,
            targets_ahead: std::slice::from_ref(&goal),
            path_ahead: self.plan.ahead(),
            obstacles: &near,
        };
        let command = match host.step(&sensed) {
            Ok(reply) => reply.value,
            Err(fault) if matches!(fault.cause, Cause::Planner(_)) => return Ok(Status::Stuck),
            Err(fault) => {
                return Err(Problem::Planner { case: method.id.to_owned(), fault: Box::new(fault) });
            }
        };
        // At 1 m/s a tick is as many seconds long as a step is metres.
        let velocity = match command.drive {
            Drive::Velocity(velocity) => velocity,
            Drive::Twist { v_m_per_s, .. } => Vector2::new(v_m_per_s, 0.0),
        };
        self.flown.push(here + velocity.cap_magnitude(1.0) * STEP_M);
        Ok(command.status)
    }

    fn is_in_range(&self, obstacle: &Obstacle<'_>) -> bool {
        match obstacle.outline {
            Outline::Disc { center, radius_m } => {
                (center - self.here()).norm() - radius_m <= self.range_m + HULL_M
            }
            _ => true,
        }
    }
}

/// A plan and how far along it the robot is.
#[derive(Default)]
struct Course {
    path: Vec<Point>,
    stations_m: Vec<f64>,
    nearest: usize,
}

impl Course {
    fn new(path: &[Point]) -> Self {
        let path = polyline::resampled(path, STEP_M);
        Self { stations_m: polyline::stations_m(&path), path, nearest: 0 }
    }

    fn advance(&mut self, at: Point) {
        let Some(from_m) = self.stations_m.get(self.nearest) else { return };
        let end_m = from_m + WINDOW_M;
        let window = (self.nearest..self.path.len()).take_while(|k| self.stations_m[*k] <= end_m);
        let distance_m = |k: usize| (self.path[k] - at).norm();
        self.nearest =
            window.min_by(|a, b| distance_m(*a).total_cmp(&distance_m(*b))).unwrap_or(self.nearest);
    }

    /// The plan from a little ahead of the robot on.
    fn ahead(&self) -> &[Point] {
        let Some(here_m) = self.stations_m.get(self.nearest) else { return &[] };
        let last = self.path.len() - 1;
        let from = self.stations_m.partition_point(|s| *s < here_m + AHEAD_M).min(last);
        let to = self.stations_m.partition_point(|s| *s <= self.stations_m[from] + SHOWN_M);
        &self.path[from..to.max(from + 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_ahead_begins_half_a_metre_on_and_ends_with_the_plan() {
        let mut course = Course::new(&[Point::origin(), Point::new(3.0, 0.0)]);
        course.advance(Point::new(1.0, 0.1));
        let ahead = course.ahead();
        assert!((ahead[0].x - 1.5).abs() < 1e-9 && (ahead[ahead.len() - 1].x - 3.0).abs() < 1e-9);
        course.advance(Point::new(2.4, 0.0));
        course.advance(Point::new(3.0, 0.0));
        assert_eq!(course.ahead().len(), 1);
        assert!(Course::default().ahead().is_empty());
    }
}
