//! Commands from the active planner: which one is sent, and in what form the robot receives it.

use super::{
    super::{
        happened::Happened,
        known::Known,
        rules::{LatePlannerRule, Verdict},
        worker::{Pending, PendingKind},
    },
    Driving,
};
use crate::{
    ask::{AskId, Said},
    event::{EventKind, rounded_command},
};
use geometry::motion::{TURN_FIRST_IN_LANES_RAD, drive_for};
use planner_api::{Command, Drive, Limits};

/// Spacing of the stored points of the path driven, which planners receive; metres.
const TRAIL_M: f64 = 0.1;

/// A command that has arrived.
#[derive(Clone)]
pub(super) struct Arrived {
    ask: AskId,
    command: Command,
    said: Said,
    /// Present if this is the first of several late commands: the number of ticks for which the robot stood still.
    late_ticks: Option<u64>,
}

impl Driving {
    /// Takes a command that was requested in this tick or in an earlier one. If several commands arrive before the tick
    /// ends, only the latest is sent.
    pub(in crate::engine) fn take_command(
        &mut self,
        (asked, usable): (&Pending, bool),
        (command, said): (Command, Said),
        known: &Known,
        happened: &mut Happened,
    ) {
        let ticks = known.tick - asked.tick;
        let late_ticks = self.late.arrived(ticks).then_some(ticks);
        let arrived = Arrived { ask: asked.id, command, said, late_ticks };
        let is_fresh = LatePlannerRule::is_fresh(ticks, known.config.tick_s);
        if !(usable && known.follows_planner() && is_fresh) {
            return self.discard(arrived, happened);
        }
        self.saved_at_s.get_or_insert(known.now_s());
        if let Some(older) = self.command.replace(arrived) {
            self.discard(older, happened);
        }
    }

    /// Sends the command for this tick, if there is one.
    pub(in crate::engine) fn send(&mut self, known: &mut Known, happened: &mut Happened) -> Option<Drive> {
        let arrived = self.command.take()?;
        let (ask, command) = (arrived.ask, arrived.command);
        self.pass_on(arrived, happened);
        let (where_to, tick_s) = ((known.is_coverage(), !known.breached.is_empty()), known.config.tick_s);
        let verdict = self.blocked.update(command.status, known.position(), where_to, tick_s);
        if let Some(Verdict::Replan(reason)) = verdict {
            self.course.want_plan(reason);
        }
        let wanted = known.sending().as_sent(command);
        let (sent, limits) = known.made_safe(wanted);
        let asked = (sent != wanted).then_some(wanted);
        happened.push(EventKind::Commanded { ask: Some(ask), command: sent, asked });
        happened.extend(limits.into_iter().flatten());
        Some(sent.drive)
    }

    /// Discards a command that has arrived but was not sent, because the robot is held or the planner is closed.
    pub(in crate::engine) fn drop_command(&mut self, happened: &mut Happened) {
        self.blocked.stand();
        if let Some(unsent) = self.command.take() {
            self.discard(unsent, happened);
        }
    }

    /// Marks the answer to an open step request as unusable.
    pub(in crate::engine) fn outdate_step(&mut self) {
        if let Some(Pending { kind: PendingKind::Step { usable }, .. }) = &mut self.worker.pending {
            *usable = false;
        }
    }

    /// Records that a command is not sent; the drawings, figures and log messages that came with it are still passed
    /// on.
    fn discard(&self, arrived: Arrived, happened: &mut Happened) {
        let ask = arrived.ask;
        self.pass_on(arrived, happened);
        happened.push(EventKind::Discarded { ask, plan: None });
    }

    /// Passes on the drawings, figures and log messages that came with a command, directly before the event for the
    /// command itself.
    fn pass_on(&self, arrived: Arrived, happened: &mut Happened) {
        if let Some(ticks) = arrived.late_ticks {
            happened.push(EventKind::PlannerLate { planner: self.id().to_owned(), ticks });
        }
        happened.pass_on(arrived.said, self.id());
    }
}

/// The data that determine, at one moment, how a command is converted on its way to the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sending {
    heading_rad: f64,
    limits: Limits,
    turn_first_rad: f64,
}

impl Sending {
    /// Converts a command to the form in which the robot receives it: within the robot's limits, for its way of moving,
    /// and rounded like all reported numbers. Converting a converted command again changes nothing, so recorded commands
    /// can be replayed.
    pub fn as_sent(&self, command: Command) -> Command {
        let drive = drive_for(command.drive, self.heading_rad, &self.limits, self.turn_first_rad);
        rounded_command(Command { drive, status: command.status })
    }
}

impl Known {
    pub(in crate::engine) fn sending(&self) -> Sending {
        Sending {
            heading_rad: self.locator.pose().heading_rad,
            limits: self.config.limits,
            // A way back is followed as exactly as lanes are.
            turn_first_rad: if self.phase.is_return() {
                TURN_FIRST_IN_LANES_RAD
            } else {
                self.config.task.turn_first_rad()
            },
        }
    }

    pub(in crate::engine) fn keep_trail(&mut self) {
        let here = self.position();
        if self.trail.last().is_none_or(|last| (here - last).norm() >= TRAIL_M) {
            self.trail.push(here);
        }
    }
}
