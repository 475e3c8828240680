//! The end of a mission: here, or after a drive back to the anchor.

use super::message::{Effect, Query};
use super::offer::{accepted, offered, refuse};
use super::overlay::{ask, open};
use super::send::{hold_now, send};
use super::unseen;
use crate::actions::ActionId;
use crate::model::{Model, Overlay, ui::Ask};
use mission::{Order, WayBack};

/// The number of ways to end a mission.
pub(super) const WAYS: usize = 2;

/// Holds the robot and shows the ways to end the mission.
pub(crate) fn begin(model: &mut Model) -> Vec<Effect> {
    let hold = hold_now(model);
    model.live.way_back = None;
    model.console.notice = None;
    open(model, Overlay::Finish { selected: 0 });
    [hold, vec![Effect::Ask(Query::WayBack)]].concat()
}

/// Asks whether to drive back.
pub(crate) fn ask_way_back(model: &mut Model) -> Vec<Effect> {
    model.live.way_back = None;
    ask(model, Ask::DriveBack);
    vec![Effect::Ask(Query::WayBack)]
}

/// Receives the way back. Without one, the open question is closed.
pub(super) fn found(model: &mut Model, way: Result<WayBack, String>) {
    let is_asked = matches!(model.ui.overlay, Overlay::Confirm(Ask::DriveBack));
    if let (Err(why), true) = (&way, is_asked) {
        let why = format!("no way back: {why}");
        model.ui.overlay = Overlay::None;
        refuse(model, why);
    } else if is_asked || matches!(model.ui.overlay, Overlay::Finish { .. }) {
        unseen::changed(model);
    }
    model.live.way_back = Some(way);
}

/// Takes the selected way to end the mission.
pub(super) fn choose(model: &mut Model, selected: usize) -> Vec<Effect> {
    if selected == 0 {
        model.ui.overlay = Overlay::None;
        return match offered(model, ActionId::Abort) {
            Ok(()) => send(model, Order::Abort),
            Err(why) => refuse(model, why),
        };
    }
    if let Err(why) = can_drive_back(model) {
        return refuse(model, why);
    }
    model.ui.overlay = Overlay::None;
    send(model, Order::DriveBack)
}

/// Checks that the robot can drive back, along a way that the operator has seen.
///
/// # Errors
/// Returns the reason why not, as a sentence.
pub(crate) fn can_drive_back(model: &Model) -> Result<(), String> {
    accepted(model, &Order::DriveBack)?;
    match &model.live.way_back {
        Some(Ok(_)) => Ok(()),
        Some(Err(why)) => Err(format!("no way back: {why}")),
        None => Err("the way back is not known yet".into()),
    }
}
