//! The mouse. It reads, scrolls and opens; questions about moving or ending are answered on the keyboard alone.

use super::act::{act, select};
use super::map;
use super::message::{Effect, Mouse, Target};
use crate::model::{Model, Overlay};

/// Lines that a step of the wheel scrolls.
const WHEEL: isize = 3;

/// Takes in what the mouse did.
pub(super) fn take(model: &mut Model, mouse: Mouse) -> Vec<Effect> {
    let is_question = matches!(model.ui.overlay, Overlay::Confirm(_) | Overlay::Quit | Overlay::Stepping);
    if is_question || !model.ui.mouse {
        return Vec::new();
    }
    let is_open = model.ui.overlay == Overlay::None;
    match mouse {
        Mouse::Click(Target::Key(id)) => return act(model, id),
        Mouse::Click(Target::Map(place)) if is_open => map::read(model, place),
        Mouse::Wheel { up, on: Target::Map(place) } if is_open => {
            map::zoom_at(model, if up { 1 } else { -1 }, place);
        }
        Mouse::Wheel { up, .. } => select(model, if up { -WHEEL } else { WHEEL }),
        Mouse::Drag { from, to } if is_open && model.ui.map.zoom > 0 => map::shift(model, from - to),
        Mouse::Click(_) | Mouse::Drag { .. } => {}
    }
    Vec::new()
}
