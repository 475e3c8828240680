//! An action on an alarm, as the list of actions offers it.

use crate::actions::ActionId;
use world::StationId;

/// The effect of an action on an alarm.
#[derive(Debug, Clone, PartialEq)]
pub enum Deed {
    /// Carries out an action of the console.
    Act(ActionId),
    /// Excludes a station from the fix (`false`), or uses it again (`true`).
    UseStation(StationId, bool),
}

/// An action on an alarm.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The action as a sentence, with keys written as `<end>`.
    pub text: String,
    /// What the action does.
    pub deed: Deed,
}
