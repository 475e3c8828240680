//! A drive over a map that is discovered on the way, across the plugin boundary.

use super::measured::{Attempt, TOLERANCE_M};
use crate::study::{Method, Planners, Result, StudyError};
use geometry::PathFollower;
use mission::Cause;
use nalgebra::Matrix3;
use planner_api::{
    Drive, Obstacle, Outline, PlanRequest, PoseEstimate, Reason, Sensed, Site, Status, Task, Vector2,
};
use planner_host::BlockingHost;
use std::time::Instant;
use trials::traps::{HULL_M, STEP_M, Trap};
use world::{Point, polyline};

/// Length of the part of its plan, ahead of the robot, that the planner receives, metres.
const SHOWN_M: f64 = 4.0;
/// Maximum number of moves of a drive, as a multiple of the number that the straight line takes.
const PATIENCE: f64 = 30.0;
/// A drive also ends after more than this number of consecutive reports of being stuck.
const MOST_STUCK: u32 = 600;

/// A point robot on its way: moves of at most 0.05 m, one per tick.
struct Journey<'a> {
    trap: &'a Trap,
    all: Vec<Obstacle<'static>>,
    seen: Vec<bool>,
    known: Vec<Obstacle<'static>>,
    range_m: f64,
    flown: Vec<Point>,
    plan: Option<PathFollower>,
    plan_times_ms: Vec<f64>,
}

/// Drives from start to goal.
///
/// # Errors
/// The planner is missing, refuses its parameters or fails.
pub(super) fn fly(planners: &Planners, method: &Method, trap: &Trap, range_m: f64) -> Result<Attempt> {
    let all = trap.obstacles(true);
    let mut journey = Journey {
        trap,
        seen: vec![false; all.len()],
        all,
        known: Vec::new(),
        range_m,
        flown: vec![trap.start],
        plan: None,
        plan_times_ms: Vec::new(),
    };
    journey.look();
    let corners = Trap::corners();
    let host = planners.prepare(method, &Trap::site(&corners, &journey.known, range_m));
    let mut host = host.map_err(|fault| StudyError::planner(&method.planner, fault))?;
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
    Ok(Attempt { path: journey.flown, plan_times_ms: journey.plan_times_ms })
}

impl Journey<'_> {
    fn here(&self) -> Point {
        self.flown[self.flown.len() - 1]
    }

    fn pose(&self) -> PoseEstimate {
        PoseEstimate { position: self.here(), heading_rad: 0.0, covariance: Matrix3::zeros() }
    }

    /// Discovers the discs within range; returns whether any disc is new.
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

    fn ask_for_plan(&mut self, host: &mut BlockingHost, reason: &Reason, method: &Method) -> Result<()> {
        let corners = Trap::corners();
        let revision = self.known.len() as u32;
        let site = Site { revision, ..Trap::site(&corners, &self.known, self.range_m) };
        let task = Task::Goto { goal: self.trap.goal, tolerance_m: TOLERANCE_M };
        let request = PlanRequest {
            reason,
            start: self.pose(),
            task,
            site: &site,
            previous: &self.flown,
            under_way: None,
        };
        let asked = Instant::now();
        let answer = host.plan(&request);
        self.plan_times_ms.push(asked.elapsed().as_secs_f64() * 1e3);
        match answer {
            Ok(reply) => {
                let path = polyline::resampled(&reply.value.path, STEP_M);
                self.plan = (!path.is_empty()).then(|| PathFollower::new(path));
            }
            // A planner without a plan may still give useful commands.
            Err(fault) if matches!(fault.cause, Cause::Planner(_)) => self.plan = None,
            Err(fault) => return Err(StudyError::planner(&method.id, fault)),
        }
        Ok(())
    }

    fn step(&mut self, host: &mut BlockingHost, tick: u64, method: &Method) -> Result<Status> {
        let here = self.here();
        if let Some(plan) = &mut self.plan {
            plan.advance(here, |_| true);
        }
        let near: Vec<Obstacle<'static>> =
            self.known.iter().filter(|obstacle| self.is_in_range(obstacle)).copied().collect();
        let goal = self.trap.goal;
        let sensed = Sensed {
            targets_ahead: std::slice::from_ref(&goal),
            path_ahead: self.plan.as_ref().map_or(&[], |plan| plan.ahead(SHOWN_M)),
            obstacles: &near,
            ..Sensed::new(tick, STEP_M, self.pose(), goal)
        };
        let command = match host.step(&sensed) {
            Ok(reply) => reply.value,
            Err(fault) if matches!(fault.cause, Cause::Planner(_)) => return Ok(Status::Stuck),
            Err(fault) => return Err(StudyError::planner(&method.id, fault)),
        };
        // At 1 m/s, the duration of a tick in seconds equals the length of a step in metres.
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
