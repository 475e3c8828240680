//! One tick of moving: the planner's command becomes what the robot is sent.

use super::{
    Mission,
    known::Known,
    rules::{LatePlannerRule, Verdict},
    slot::{Arrived, Pending},
};
use crate::{
    ask::Said,
    event::{EventKind, rounded_command},
    phase::{Gait, Hold, HoldReason, Phase, Resumes},
    task::Task,
};
use geometry::motion::drive_for;
use planner_api::{Command, Drive, Limits};

/// Distance between the points of the path flown that are kept for planners, metres.
const TRAIL_M: f64 = 0.1;

/// What a command becomes on its way to the robot, at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sending {
    heading_rad: f64,
    limits: Limits,
    turn_first_rad: f64,
}

impl Sending {
    /// A command as the robot is sent it: within its limits, in its own way of moving, and rounded as everything that is
    /// reported. Doing this to a command that was sent changes nothing, so that recorded commands can be fed in again.
    pub fn as_sent(&self, command: Command) -> Command {
        let drive = drive_for(command.drive, self.heading_rad, &self.limits, self.turn_first_rad);
        rounded_command(Command { drive, status: command.status })
    }
}

impl Mission {
    /// Sends the robot the command of this tick; without one it stands still.
    pub(super) fn drive(&mut self) -> Drive {
        let Phase::Running(gait) = self.known.phase else { return Drive::STILL };
        let Some(arrived) = self.active.command.take() else { return Drive::STILL };
        let (ask, command) = (arrived.ask, arrived.command);
        self.pass_on_with(arrived);
        let (here, in_lanes) = (self.known.position(), self.known.is_coverage());
        let verdict = self.active.blocked.update(command.status, here, in_lanes, self.known.config.tick_s);
        if let Some(Verdict::Replan(reason)) = verdict {
            self.active.want_plan(reason);
        }
        let wanted = self.known.sending().as_sent(command);
        let sent = self.known.governed(wanted);
        let asked = (sent != wanted).then_some(wanted);
        self.happened.push(EventKind::Commanded { ask: Some(ask), command: sent, asked });
        self.happened.extend(self.known.note_limit(wanted, sent));
        if gait == Gait::OneTick {
            self.hold(Hold { by: HoldReason::Stepped, resumes: Resumes::Never });
        }
        sent.drive
    }
}

impl Known {
    pub(super) fn sending(&self) -> Sending {
        Sending {
            heading_rad: self.locator.pose().heading_rad,
            limits: self.config.limits,
            turn_first_rad: self.config.task.turn_first_rad(),
        }
    }
}

impl Mission {
    /// Takes a command of the active planner, which was asked for in this tick or in an earlier one. The freshest one
    /// that arrives before the tick ends is sent.
    pub(super) fn take_command(&mut self, asked: &Pending, usable: bool, command: Command, said: Said) {
        let ticks = self.known.tick - asked.tick;
        let late_ticks = self.active.late.arrived(ticks).then_some(ticks);
        let arrived = Arrived { ask: asked.id, command, said, late_ticks };
        if !(usable && LatePlannerRule::is_fresh(ticks as f64 * self.known.config.tick_s)) {
            return self.discard(arrived);
        }
        let now_s = self.known.now_s();
        self.active.saved_at_s.get_or_insert(now_s);
        if let Some(older) = self.active.command.replace(arrived) {
            self.discard(older);
        }
    }

    /// Notes that a command is not sent; what the planner said with it is passed on all the same.
    pub(super) fn discard(&mut self, arrived: Arrived) {
        let ask = arrived.ask;
        self.pass_on_with(arrived);
        self.happened.push(EventKind::Discarded { ask, plan: None });
    }

    /// What there is to report with a command, directly before what becomes of it.
    fn pass_on_with(&mut self, arrived: Arrived) {
        let planner = self.active.choice.id.clone();
        if let Some(ticks) = arrived.late_ticks {
            self.happened.push(EventKind::PlannerLate { planner: planner.clone(), ticks });
        }
        self.happened.pass_on(arrived.said, &planner);
    }
}

impl Known {
    pub(super) fn keep_trail(&mut self) {
        let here = self.locator.position();
        if self.trail.last().is_none_or(|last| (here - last).norm() >= TRAIL_M) {
            self.trail.push(here);
        }
    }
}
