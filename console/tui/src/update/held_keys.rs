//! Keys that are held down: they agree to nothing and step nothing.
//!
//! Few terminals say that a key repeats, so time has to tell. A key that is held down repeats for the first time after half a
//! second or so, and then many times a second. A press within [`KeyPress::REPEATS_WITHIN`] of the same key is a repeat; one
//! that comes later may be the first repeat, and counts only when no other press follows it as soon.

use super::message::Effect;
use super::press_key;
use crate::actions::ActionId;
use crate::keys::{Freshness, KeyPress};
use crate::model::{Model, Overlay, Settling};

/// Whether an action agrees to what is open over the screen, or moves the robot.
pub(super) fn is_agreement(model: &Model, id: ActionId) -> bool {
    let agrees = matches!(
        id,
        ActionId::Accept | ActionId::Edit | ActionId::Step | ActionId::StepLane | ActionId::StepEvent
    );
    agrees && model.ui.overlay != Overlay::None
}

/// Whether a key was pressed, as far as that is known; if it is not, the press waits until it is.
pub(super) fn is_pressed(model: &mut Model, press: KeyPress) -> bool {
    match press.freshness() {
        Freshness::Fresh => true,
        Freshness::Held => false,
        Freshness::Unclear => {
            model.console.settling = Some(Settling {
                key: press.key,
                over: model.ui.overlay.clone(),
                until_mono_s: model.console.now.mono_s + KeyPress::REPEATS_WITHIN.as_secs_f64(),
            });
            false
        }
    }
}

/// No other press has followed: the key was pressed, and does what it does if the same is still open.
pub(super) fn settled(model: &mut Model) -> Vec<Effect> {
    let Some(settling) = model.console.settling.take() else { return Vec::new() };
    if settling.over != model.ui.overlay {
        return Vec::new();
    }
    press_key(model, settling.key.into())
}
