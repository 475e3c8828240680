//! Limits commands, tracks the robot's speed as the mission knows it, and reports planners that are slowed down.

pub(super) mod guarding;
mod scan_fault;
pub(super) mod state;

use super::known::Known;
use crate::{
    event::{EventKind, rounded_command},
    governor::{self, Here, Surroundings},
};
use geometry::{Braking, Drive};
use planner_api::{Command, Limits};
use world::{Medium, Mode, Point};

/// Ratio of the speed sent to the speed requested below which a command counts as limited.
const LIMITED_SHARE: f64 = 0.9;
/// A planner is reported after being slowed down for this long, seconds.
const NAMED_AFTER_S: f64 = 2.0;

impl Known {
    /// The robot's own speed, metres per second: the commanded speed, to the extent that the robot's acceleration has
    /// allowed it to be reached.
    pub(super) fn speed_m_per_s(&self) -> f64 {
        self.governor.momentum.speed_m_per_s()
    }

    /// The place where the robot stands if it is told to stop now, tank frame.
    pub(super) fn stops_at(&self) -> Point {
        let (here, momentum) = (self.as_governed(), &self.governor.momentum);
        let way_m = Braking::of(&here.limits).distance_m(momentum.speed_m_per_s());
        here.pose.position + momentum.direction(here.pose) * way_m
    }

    /// Limits a command to what is safe according to the chart and the scan. Returns the limited command and the events
    /// to report.
    pub(super) fn made_safe(&mut self, wanted: Command) -> (Command, [Option<EventKind>; 2]) {
        let governed = self.governed(wanted);
        let sent = self.guarded(governed);
        let limited = self.note_limit(wanted, governed);
        (sent, [limited, self.note_guard(governed.drive, sent.drive)])
    }

    /// Slows a command down, if necessary, so that the robot can stop in time.
    fn governed(&self, command: Command) -> Command {
        let (here, momentum) = (self.as_governed(), &self.governor.momentum);
        let reach_m = governor::reach_m(momentum, command.drive, &here);
        let is_free = self.chart.is_free(here.pose.position, reach_m);
        if is_free && governor::is_within_sight(momentum, command.drive, &here) {
            return command;
        }
        // The way back may lead deeper into a zone before it leads out of it.
        let leaving = if self.phase.is_return() { self.breached.as_slice() } else { &[] };
        let solids = self.chart.solids(here.pose.position, reach_m, leaving);
        let around = Surroundings::of(&solids, &here);
        let drive = governor::governed(momentum, command.drive, &here, &around);
        rounded_command(Command { drive, ..command })
    }

    /// Reports a planner once it has been slowed down for long enough.
    fn note_limit(&mut self, asked: Command, sent: Command) -> Option<EventKind> {
        let (asked_m_per_s, sent_m_per_s) = (speed(asked.drive), speed(sent.drive));
        let is_limited = sent_m_per_s < LIMITED_SHARE * asked_m_per_s;
        let needs_m = Braking::of(&self.as_governed().limits).distance_m(asked_m_per_s);
        let is_named = self.governor.limited.update(is_limited, self.config.tick_s, NAMED_AFTER_S);
        is_named.then_some(EventKind::SpeedLimited { asked_m_per_s, sent_m_per_s, needs_m })
    }

    /// Records the motion that is sent to the robot.
    pub(super) fn follow_drive(&mut self, drive: Drive) {
        self.remember_sent(drive);
        let here = self.as_governed();
        self.governor.momentum = self.governor.momentum.after(drive, &here);
    }

    /// Processes a reading from the pressure sensor.
    pub(super) fn take_pressure(&mut self, pressure_pa: Option<f64>) -> Option<EventKind> {
        let (sensor, pressure_pa) = (self.config.pressure?, pressure_pa?);
        let is_first = !self.knows_medium();
        let medium = self.governor.sensed.take(&sensor, pressure_pa)?;
        if is_first {
            self.governor.mode = Mode::of(medium);
        }
        Some(EventKind::MediumKnown { medium, pressure_pa })
    }

    /// Whether the robot can move: a robot with a pressure sensor waits until the sensor has decided whether it is to
    /// walk or swim.
    pub(super) fn knows_medium(&self) -> bool {
        self.config.pressure.is_none() || self.governor.sensed.known().is_some()
    }

    /// Switches between walking and swimming, as required by the floor under the robot.
    pub(super) fn update_mode(&mut self) -> Option<EventKind> {
        let amphibious = self.config.limits.amphibious?;
        let by_place = || Medium::at(&self.chart.world().zones, self.locator.position());
        let medium =
            if self.config.pressure.is_some() { self.governor.sensed.known() } else { Some(by_place()) };
        if let Some(medium) = medium {
            self.governor.mode = self.governor.mode.toward(medium, amphibious.transition_steps);
        } else if self.is_running() && !std::mem::replace(&mut self.governor.has_said_that_it_waits, true) {
            return Some(EventKind::MediumAwaited);
        }
        None
    }

    pub(super) fn as_governed(&self) -> Here {
        let limits = match self.config.limits.amphibious {
            Some(amphibious) => {
                let pace = amphibious.pace(self.governor.mode.weight());
                let (v_max_m_per_s, w_max_rad_per_s) = (pace.v_max_m_per_s, pace.w_max_rad_per_s);
                Limits { v_max_m_per_s, w_max_rad_per_s, ..self.config.limits }
            }
            None => self.config.limits,
        };
        Here { pose: self.locator.pose(), error_m: self.locator.error_95_m(), limits }
    }
}

fn speed(drive: Drive) -> f64 {
    match drive {
        Drive::Twist { v_m_per_s, .. } => v_m_per_s.abs(),
        Drive::Velocity(velocity) => velocity.norm(),
    }
}
