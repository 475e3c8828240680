//! The explanation of an alarm, and the remedies that several alarms share.

use crate::actions::ActionId;
use crate::model::{Run, alarms::rule::Context};
use mission::Phase;
use vehicle::port::LinkState;

/// The explanation of an alarm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guide {
    /// Why the alarm is raised.
    pub cause: &'static str,
    /// When the cause holds a moving robot, as a sentence; empty if the cause does not hold the
    /// robot.
    pub holds: &'static str,
    /// The other consequences, which do not depend on the state of the mission; empty if none are
    /// known.
    pub effect: &'static str,
    /// What the operator can do; at most four remedies. Those without an action are advice.
    pub remedies: &'static [Remedy],
}

/// A remedy for an alarm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Remedy {
    /// The remedy as a sentence.
    pub text: &'static str,
    /// The action that carries out the remedy; `None` if the operator must act elsewhere or wait.
    pub action: Option<ActionId>,
    /// When the remedy applies.
    pub when: When,
}

/// When a remedy applies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum When {
    /// Always.
    Any,
    /// While the robot may move.
    Moving,
    /// Before the start.
    Waiting,
    /// During a hold, as long as a vehicle that is held can still be reached.
    Held,
    /// During a hold that ends automatically.
    Resuming,
    /// Until the end of the mission.
    BeforeEnd,
    /// Until the end of a mission that a planner drives; a survey drives without one.
    Planned,
}

impl When {
    /// Whether a remedy applies to a run now.
    pub fn holds(self, run: &Run) -> bool {
        let phase = run.phase();
        let is_closed = run.vehicle.as_ref().is_some_and(|vehicle| vehicle.link.state == LinkState::Closed);
        match self {
            Self::Any => true,
            Self::Waiting => Context::of(phase) == Context::Planning,
            Self::Held => Context::of(phase) == Context::Held && !is_closed,
            Self::Moving => Context::of(phase).moves(),
            Self::Resuming => matches!(phase, Phase::Held(hold) if !hold.resumes.is_never()),
            Self::BeforeEnd => Context::of(phase) != Context::Ended,
            Self::Planned => Context::of(phase) != Context::Ended && !run.is_survey(),
        }
    }
}

/// Advice that ends with the mission.
pub(super) const fn wait(text: &'static str) -> Remedy {
    Remedy { text, action: None, when: When::BeforeEnd }
}

/// Advice that does not depend on the mission.
pub(super) const fn check(text: &'static str) -> Remedy {
    Remedy { text, action: None, when: When::Any }
}

pub(super) const fn run(text: &'static str, action: ActionId) -> Remedy {
    Remedy { text, action: Some(action), when: When::Any }
}

impl Remedy {
    pub(super) const fn when(self, when: When) -> Self {
        Self { when, ..self }
    }
}

pub(super) const STAY: Remedy =
    run("Stay held (HOLD): then only the operator can resume the mission.", ActionId::Hold)
        .when(When::Resuming);
pub(super) const HOLD: Remedy =
    run("HOLD the robot until this is resolved.", ActionId::Hold).when(When::Moving);
pub(super) const END: Remedy =
    run("End the mission (<end>). Holds, then asks.", ActionId::Abort).when(When::BeforeEnd);
pub(super) const SHOW: Remedy = run("Show it on the map.", ActionId::ShowPlace);
pub(super) const SLOWER: Remedy = run("Slow the simulation down (<slower>).", ActionId::Slower);
pub(super) const OTHER_PLANNER: Remedy =
    run("Change the planner (<planner>). Asks first.", ActionId::ChoosePlanner).when(When::Planned);
pub(super) const PARAMETERS: Remedy =
    run("Change the planner's parameters (<parameters>).", ActionId::Parameters).when(When::Planned);
pub(super) const RESUME: Remedy =
    run("Resume: the planner tries again. Asks first.", ActionId::Resume).when(When::Held);
pub(super) const PLAN_AGAIN: Remedy =
    run("Plan again: the planner is restarted.", ActionId::PlanAgain).when(When::Waiting);
