//! What an alarm means, and what can be done about several of them.

use crate::actions::ActionId;

/// What an alarm means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guide {
    /// Why it comes.
    pub cause: &'static str,
    /// What follows from it.
    pub effect: &'static str,
    /// What can be done, four at most.
    pub remedies: &'static [Remedy],
}

/// Something that can be done about an alarm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Remedy {
    /// What, as a sentence.
    pub text: &'static str,
    /// The action that does it; `None`: it is for the operator to do, or to wait for.
    pub action: Option<ActionId>,
}

pub(super) const fn wait(text: &'static str) -> Remedy {
    Remedy { text, action: None }
}

pub(super) const fn run(text: &'static str, action: ActionId) -> Remedy {
    Remedy { text, action: Some(action) }
}

pub(super) const STAY: Remedy = run("Keep held (HOLD): then only the operator resumes.", ActionId::Hold);
pub(super) const HOLD: Remedy = run("HOLD the robot until this is clear.", ActionId::Hold);
pub(super) const END: Remedy = run("End the mission (<end>): holds, then asks.", ActionId::Abort);
pub(super) const SHOW: Remedy = run("Show it on the map.", ActionId::ShowPlace);
pub(super) const SLOWER: Remedy = run("Slow the simulation down (<slower>).", ActionId::Slower);
pub(super) const OTHER_PLANNER: Remedy =
    run("Change the planner (<planner>): asks first.", ActionId::ChoosePlanner);
pub(super) const PARAMETERS: Remedy =
    run("Change parameters of the planner (<parameters>).", ActionId::Parameters);
pub(super) const RESUME: Remedy = run("Resume: the planner tries again; asks first.", ActionId::Resume);
