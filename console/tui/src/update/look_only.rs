//! What a console that looks on does not do.

use super::offer::demand;
use crate::actions::{Action, Reach};
use crate::model::{Access, Model};

/// Whether this console may do such things at all.
pub(super) fn allowed(model: &Model, action: &Action) -> Result<(), String> {
    match model.live.access {
        Access::Control => Ok(()),
        Access::LookOnly => demand(action.reach == Reach::Screen, LOOK_ONLY),
        Access::Replay => demand(action.reach != Reach::Mission, REPLAY),
    }
}

/// Why no mission here takes an order, if none does.
pub(super) fn no_orders(model: &Model) -> Result<(), String> {
    match model.live.access {
        Access::Control => Ok(()),
        Access::LookOnly => Err(LOOK_ONLY.into()),
        Access::Replay => Err(REPLAY.into()),
    }
}

/// Why a console that looks on does not do something.
const LOOK_ONLY: &str = "VIEW: this console only looks on; use the console that runs the mission";

/// Why a replay does not do something.
const REPLAY: &str = "REPLAY: a past run takes no orders; <home>: open a scenario";
