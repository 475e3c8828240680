//! What a console that looks on does not do.

use super::offer::demand;
use crate::actions::ActionId;
use crate::model::{Access, Model};

/// Whether this console may do such things at all.
pub(super) fn allowed(model: &Model, id: ActionId) -> Result<(), String> {
    match model.live.access {
        Access::Control => Ok(()),
        Access::LookOnly => demand(!acts(id) && !opens(id), LOOK_ONLY),
        Access::Replay => demand(!acts(id) || plays(id), REPLAY),
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

/// Whether an action is one of the replay, too.
fn plays(id: ActionId) -> bool {
    matches!(id, ActionId::Hold | ActionId::Slower | ActionId::Faster | ActionId::SetSpeed)
}

/// Whether an action opens another run, or writes into the folder of one.
fn opens(id: ActionId) -> bool {
    use ActionId::{Bookmark, CompareRun, Open, Remark, Replay, Report, Rescan, Unmark};
    matches!(id, Open | Replay | CompareRun | Rescan | Report | Bookmark | Unmark | Remark)
}

/// Whether an action does something to a mission or its files.
fn acts(id: ActionId) -> bool {
    use ActionId::{
        Abort, Acknowledge, AcknowledgeAll, Again, CancelPlan, ChoosePlanner, Compare, DrawZone, DropShadow,
        Exclude, Faster, FlyUncertified, Hold, Include, Inject, PlanAgain, Preflight, Promote, Reload,
        Resume, SetParameter, SetSpeed, Shadow, Shelve, Slower, Start, Step, StepEvent, StepLane, TakePlan,
        WhatIf,
    };
    let moves = matches!(id, Hold | Start | Resume | FlyUncertified | Step | StepLane | StepEvent | Abort);
    let plans = matches!(
        id,
        TakePlan | ChoosePlanner | Compare | PlanAgain | CancelPlan | Preflight | WhatIf | Reload
    );
    let shadows = matches!(id, Shadow | Promote | DropShadow);
    let sets =
        matches!(id, SetParameter | SetSpeed | Slower | Faster | Inject | Exclude | Include | DrawZone);
    let alarms = matches!(id, Acknowledge | AcknowledgeAll | Shelve);
    moves || plans || shadows || sets || alarms || id == Again
}
