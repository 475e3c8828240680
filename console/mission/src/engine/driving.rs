//! One tick of moving: ask the planner, send the robot its answer.

use super::Mission;
use crate::{
    drive::{TURN_FIRST_IN_LANES_RAD, TURN_FIRST_RAD, drive_for},
    event::EventKind,
    planner::{Cause, Fault, PlannerLink},
    task::Task,
};
use planner_api::{Command, Drive, Reason, Sensed, Status};
use world::Point;

/// How much of the targets and of the plan a planner sees ahead, metres.
const AHEAD_M: f64 = 4.0;
/// A planner that has been stuck in its lanes for this long is asked for new ones, seconds.
const BLOCKED_S: f64 = 1.0;
/// So many plans are asked for in one place.
const MOST_PLANS: usize = 4;
/// A robot that is blocked further away than this is blocked in another place, metres.
const MOVED_ON_M: f64 = 0.3;
/// A planner that answers too late again within this time holds the robot, seconds.
const LATE_AGAIN_S: f64 = 60.0;
/// Distance between the points of the path flown that are kept for planners, metres.
const TRAIL_M: f64 = 0.1;

impl Mission {
    pub(super) fn drive(&mut self, planner: &mut dyn PlannerLink) -> Drive {
        let command = self.plan_if_due(planner).and_then(|()| self.ask_for_command(planner));
        match command {
            Ok(Some(command)) => {
                self.replan_if_blocked(command.status);
                self.send(command)
            }
            Ok(None) => Drive::STILL,
            Err(message) => {
                self.hold_for_planner(message);
                Drive::STILL
            }
        }
    }

    /// The plan from here on. Lanes are followed by the task itself, which knows how far it is.
    fn path_ahead(&self) -> &[Point] {
        match &self.task {
            Task::Cover(_) => self.task.targets_ahead(AHEAD_M),
            Task::Goto(_) | Task::Follow { .. } => self.plan.as_ref().map_or(&[], |plan| plan.ahead(AHEAD_M)),
        }
    }

    /// A planner that cannot go on along its lanes is asked for new ones from where the robot stands; not at once again,
    /// for the robot may have to turn or to be seen better first.
    fn replan_if_blocked(&mut self, status: Status) {
        self.blocked_s = if status == Status::Stuck { self.blocked_s + self.config.tick_s } else { 0.0 };
        if self.blocked_s < BLOCKED_S || !matches!(self.task, Task::Cover(_)) {
            return;
        }
        self.blocked_s = 0.0;
        let here = self.locator.position();
        let (at, times) =
            self.blocked_at.filter(|(at, _)| (here - at).norm() < MOVED_ON_M).unwrap_or((here, 0));
        self.blocked_at = Some((at, times + 1));
        // Plans that all begin with the same obstacle do not help: the rule for a robot that is stuck takes over.
        if times < MOST_PLANS {
            self.planner.plan_due.get_or_insert(Reason::Blocked);
        }
    }

    /// What the planner commands; nothing for this tick when its answer came too late once.
    fn ask_for_command(&mut self, planner: &mut dyn PlannerLink) -> Result<Option<Command>, String> {
        let pose = self.locator.pose_estimate();
        let here = pose.position;
        self.keep_trail();
        if let Some(plan) = &mut self.plan {
            plan.advance(here, self.chart.map(), 0.0);
        }
        let (v_m_per_s, w_rad_per_s) = match self.last_drive {
            Drive::Twist { v_m_per_s, w_rad_per_s } => (v_m_per_s, w_rad_per_s),
            Drive::Velocity(velocity) => (velocity.norm(), 0.0),
        };
        let obstacles = self.chart.near(here);
        let answer = planner.step(&Sensed {
            tick: self.tick,
            t_s: self.now_s(),
            dt_s: self.config.tick_s,
            pose,
            v_m_per_s,
            w_rad_per_s,
            target: self.task.target(),
            targets_ahead: self.task.targets_ahead(AHEAD_M),
            path_ahead: self.path_ahead(),
            obstacles: &obstacles,
        });
        drop(obstacles);
        match answer {
            Ok(reply) => {
                let command = reply.value;
                self.pass_on(reply);
                Ok(Some(command))
            }
            Err(fault) if self.is_late_once(&fault) => {
                let message = format!("{}; the robot stood still for that tick", fault.message);
                self.happened.push(EventKind::PlannerFailed { fault: Fault { message, ..fault } });
                Ok(None)
            }
            Err(fault) => Err(self.note_fault(fault)),
        }
    }

    /// Whether a planner whose process is well answered too late, and not so before in a while: a busy machine costs a
    /// tick, not the mission.
    fn is_late_once(&mut self, fault: &Fault) -> bool {
        if fault.cause != Cause::Late {
            return false;
        }
        let now_s = self.now_s();
        let before_s = self.late_at_s.replace(now_s);
        before_s.is_none_or(|before_s| now_s - before_s > LATE_AGAIN_S)
    }

    fn send(&mut self, command: Command) -> Drive {
        let turn_first_rad = match self.task {
            Task::Cover(_) => TURN_FIRST_IN_LANES_RAD,
            Task::Goto(_) | Task::Follow { .. } => TURN_FIRST_RAD,
        };
        let heading_rad = self.locator.pose().heading_rad;
        let drive = drive_for(command.drive, heading_rad, &self.config.limits, turn_first_rad);
        self.happened.push(EventKind::Commanded { command: Command { drive, status: command.status } });
        drive
    }

    fn keep_trail(&mut self) {
        let here = self.locator.position();
        if self.trail.last().is_none_or(|last| (here - last).norm() >= TRAIL_M) {
            self.trail.push(here);
        }
    }
}
