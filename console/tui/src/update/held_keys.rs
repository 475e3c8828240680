//! Held keys: a key that is held down neither confirms a question nor makes a step.
//!
//! Few terminals report that a key repeats, so the console judges by time. A held key first repeats after about half
//! a second, and then many times a second. A press within [`KeyPress::REPEATS_WITHIN`] of the same key is a repeat. A
//! later press may be the first repeat, so it counts only if no other press follows within that time.

use super::message::Effect;
use super::press_key;
use crate::actions::ActionId;
use crate::keys::{Freshness, KeyPress};
use crate::model::{Model, Overlay, Settling};

/// Whether an action confirms the open question or moves the robot.
pub(super) fn is_agreement(model: &Model, id: ActionId) -> bool {
    let agrees = matches!(
        id,
        ActionId::Accept | ActionId::Edit | ActionId::Step | ActionId::StepLane | ActionId::StepEvent
    );
    agrees && model.ui.overlay != Overlay::None
}

/// Whether a key was really pressed; if that is not yet clear, the press is kept until it is.
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

/// No other press has followed, so the key was pressed: carries out its action if the overlay is still the same.
pub(super) fn settled(model: &mut Model) -> Vec<Effect> {
    let Some(settling) = model.console.settling.take() else { return Vec::new() };
    if settling.over != model.ui.overlay {
        return Vec::new();
    }
    press_key(model, settling.key.into())
}
