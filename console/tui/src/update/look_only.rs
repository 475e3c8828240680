//! What a console that looks on does not do.

use super::offer::demand;
use crate::actions::ActionId;
use crate::model::Model;

/// Whether this console may do such things at all.
pub(super) fn allowed(model: &Model, id: ActionId) -> Result<(), String> {
    demand(!(model.live.is_look_only() && acts(id)), LOOK_ONLY)
}

/// Why a console that looks on does not do something.
pub(super) const LOOK_ONLY: &str = "VIEW: this console only looks on; use the console that runs the mission";

/// Whether an action does something to a mission or its files.
fn acts(id: ActionId) -> bool {
    use ActionId::{
        Abort, Acknowledge, AcknowledgeAll, Again, CancelPlan, ChoosePlanner, Compare, DropShadow, Exclude,
        Faster, FlyUncertified, Hold, Include, Inject, Open, PlanAgain, Preflight, Promote, Reload, Report,
        Rescan, Resume, SetParameter, SetSpeed, Shadow, Shelve, Slower, Start, Step, StepEvent, StepLane,
        WhatIf,
    };
    let moves = matches!(id, Hold | Start | Resume | FlyUncertified | Step | StepLane | StepEvent | Abort);
    let plans = matches!(id, ChoosePlanner | Compare | PlanAgain | CancelPlan | Preflight | WhatIf | Reload);
    let shadows = matches!(id, Shadow | Promote | DropShadow);
    let sets = matches!(id, SetParameter | SetSpeed | Slower | Faster | Inject | Exclude | Include);
    let alarms = matches!(id, Acknowledge | AcknowledgeAll | Shelve);
    moves || plans || shadows || sets || alarms || matches!(id, Open | Again | Rescan | Report)
}
