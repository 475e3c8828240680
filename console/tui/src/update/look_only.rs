//! The actions that a view-only console refuses.

use super::offer::demand;
use crate::actions::{Action, Reach};
use crate::model::{Access, Model};

/// Checks that this console is allowed to carry out an action.
pub(super) fn allowed(model: &Model, action: &Action) -> Result<(), String> {
    match model.live.access {
        Access::Control => Ok(()),
        Access::LookOnly => demand(action.reach == Reach::Screen, LOOK_ONLY),
        Access::Replay => demand(action.reach != Reach::Mission, REPLAY),
    }
}

/// Checks that this console can give orders; the error is the reason why it cannot.
pub(super) fn no_orders(model: &Model) -> Result<(), String> {
    match model.live.access {
        Access::Control => Ok(()),
        Access::LookOnly => Err(LOOK_ONLY.into()),
        Access::Replay => Err(REPLAY.into()),
    }
}

/// The refusal of a view-only console.
const LOOK_ONLY: &str = "VIEW only: give orders on the console that runs the mission";

/// The refusal of a replay.
const REPLAY: &str = "replay, no robot connected; <home>: open a scenario";
