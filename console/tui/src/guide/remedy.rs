//! The explanation of an alarm, and the remedies that several alarms share.

use crate::actions::ActionId;

/// The explanation of an alarm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guide {
    /// Why the alarm is raised.
    pub cause: &'static str,
    /// The consequence.
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
    /// Whether advice still makes sense after the end of the mission.
    pub outlasts_mission: bool,
}

/// Advice that ends with the mission.
pub(super) const fn wait(text: &'static str) -> Remedy {
    Remedy { text, action: None, outlasts_mission: false }
}

/// Advice that does not depend on the mission.
pub(super) const fn check(text: &'static str) -> Remedy {
    Remedy { text, action: None, outlasts_mission: true }
}

pub(super) const fn run(text: &'static str, action: ActionId) -> Remedy {
    Remedy { text, action: Some(action), outlasts_mission: true }
}

pub(super) const STAY: Remedy =
    run("Stay held (HOLD): then only the operator can resume the mission.", ActionId::Hold);
pub(super) const HOLD: Remedy = run("HOLD the robot until this is resolved.", ActionId::Hold);
pub(super) const END: Remedy = run("End the mission (<end>). Holds, then asks.", ActionId::Abort);
pub(super) const SHOW: Remedy = run("Show it on the map.", ActionId::ShowPlace);
pub(super) const SLOWER: Remedy = run("Slow the simulation down (<slower>).", ActionId::Slower);
pub(super) const OTHER_PLANNER: Remedy =
    run("Change the planner (<planner>). Asks first.", ActionId::ChoosePlanner);
pub(super) const PARAMETERS: Remedy =
    run("Change the planner's parameters (<parameters>).", ActionId::Parameters);
pub(super) const RESUME: Remedy = run("Resume: the planner tries again. Asks first.", ActionId::Resume);
