//! Questions that the operator cannot have read: a key answers a question only if the question was on the screen, and
//! for a moment, before the key was pressed.
//!
//! Keys arrive in bursts: typed ahead, repeated by a slow line, or sent by a program. Such a burst must not confirm a
//! question that its own first key opened. A key from a script names no frame and always counts.

use crate::keys::KeyPress;
use crate::model::{Model, Overlay, console::Appeared};

/// Minimum age of a question that a key may answer, seconds.
const READ_S: f64 = 0.2;

/// The open question, if any.
pub(super) fn question(model: &Model) -> Option<&Overlay> {
    Some(&model.ui.overlay).filter(|overlay| overlay.is_question())
}

/// Records when a question appears; `before` is the question that was open before the message.
pub(super) fn note(model: &mut Model, before: Option<&Overlay>) {
    let now = question(model);
    if now == before {
        return;
    }
    match now {
        Some(_) => changed(model),
        None => model.console.appeared = None,
    }
}

/// Records that the text of the open question has changed: it must be read again.
pub(super) fn changed(model: &mut Model) {
    model.console.appeared = Some(Appeared { at_mono_s: model.console.now.mono_s, frame: None });
}

/// Records that the open question is on the screen, from this frame on.
pub(super) fn drawn(model: &mut Model, frame: u64) {
    let at_mono_s = model.console.now.mono_s;
    if let Some(appeared) = model.console.appeared.as_mut().filter(|appeared| appeared.frame.is_none()) {
        *appeared = Appeared { at_mono_s, frame: Some(frame) };
    }
}

/// Whether a key was pressed before the operator can have read the open question; if so, tells the operator that the
/// key does not count.
pub(super) fn is_too_early(model: &mut Model, press: KeyPress) -> bool {
    let (Some(seen), Some(appeared)) = (press.seen, &model.console.appeared) else { return false };
    let was_shown = appeared.frame.is_some_and(|frame| frame <= seen);
    if was_shown && model.console.now.mono_s - appeared.at_mono_s >= READ_S {
        return false;
    }
    model.hint(format!("the question has just appeared; press {} again", press.key));
    true
}
