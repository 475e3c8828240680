//! Mouse input. The mouse inspects, scrolls, selects and opens; questions about moving or ending can only be answered
//! with the keyboard.

use super::act::{act, select};
use super::message::{Effect, Mouse, Rows, Target};
use super::{map, zones};
use crate::actions::{ACTIONS, ActionId, context::contexts};
use crate::model::home::HomeList;
use crate::model::{Model, Overlay, Pane};

/// Lines scrolled per wheel step.
const WHEEL: isize = 3;

/// Handles mouse input.
pub(super) fn take(model: &mut Model, mouse: Mouse) -> Vec<Effect> {
    if model.ui.overlay.is_question() || !model.ui.mouse {
        return Vec::new();
    }
    let is_open = model.ui.overlay == Overlay::None;
    match mouse {
        Mouse::Click(Target::Map(place)) if zones::point_at(model, place) => {}
        Mouse::Drag { from, to } if zones::drag(model, from, to) => {}
        // While a list is open, a click on a key or line beneath it does nothing.
        Mouse::Click(Target::Key(id)) if works(model, id) => return act(model, id),
        Mouse::Click(Target::Map(place)) if is_open => map::read(model, place),
        Mouse::Click(Target::Row(list, index)) if is_open => return click(model, list, index),
        Mouse::Wheel { up, on: Target::Map(place) } if is_open => {
            map::zoom_at(model, if up { 1 } else { -1 }, place);
        }
        Mouse::Wheel { up, on } => {
            if let Target::Row(list, _) = on
                && is_open
            {
                focus(model, list);
            }
            select(model, if up { -WHEEL } else { WHEEL });
        }
        Mouse::Drag { from, to } if is_open && model.ui.map.zoom > 0 => map::shift(model, from - to),
        Mouse::Click(_) | Mouse::Drag { .. } => {}
    }
    Vec::new()
}

/// Whether the key of an action works now.
fn works(model: &Model, id: ActionId) -> bool {
    let contexts = contexts(model);
    ACTIONS.iter().any(|action| action.id == id && action.works_in(&contexts))
}

/// Selects a line. A click on the selected line opens it, as Enter does, which never moves the robot.
fn click(model: &mut Model, list: Rows, index: usize) -> Vec<Effect> {
    let was_focused = !focus(model, list);
    let before = selected(model, list);
    let opens = matches!(
        list,
        Rows::Scenarios
            | Rows::Runs
            | Rows::Attention
            | Rows::Alarms
            | Rows::Events
            | Rows::LeftOut
            | Rows::Past
    );
    if was_focused && before == index {
        return if opens { act(model, ActionId::Accept) } else { Vec::new() };
    }
    select(model, index as isize - before as isize);
    Vec::new()
}

/// Makes a list respond to the arrow keys; returns whether a different list or pane did so before.
fn focus(model: &mut Model, list: Rows) -> bool {
    let wanted = match list {
        Rows::Scenarios => HomeList::Scenarios,
        Rows::Runs => HomeList::Runs,
        Rows::Attention => HomeList::Attention,
        Rows::LeftOut => return std::mem::replace(&mut model.ui.pane, Pane::LeftOut) != Pane::LeftOut,
        Rows::Alarms | Rows::Events | Rows::Plugins | Rows::Past => {
            let was_in_detail = model.ui.in_detail;
            model.ui.turn_to_list();
            return was_in_detail;
        }
        Rows::Missed => return false,
    };
    std::mem::replace(&mut model.home.list, wanted) != wanted
}

/// The index of the selected line in a list.
fn selected(model: &Model, list: Rows) -> usize {
    match list {
        Rows::Scenarios => model.home.scenario,
        Rows::Runs => model.home.run,
        Rows::Attention => model.home.attention,
        Rows::Alarms => {
            let chosen = model.selected_alarm().map(|alarm| &alarm.cause);
            let table = model.live.run.alarms.table();
            table.iter().position(|alarm| Some(&alarm.cause) == chosen).unwrap_or(0)
        }
        Rows::Events => model.ui.events.newer(),
        Rows::Plugins => model.ui.plugin,
        Rows::Missed => model.ui.missed,
        Rows::LeftOut => model.ui.left_out,
        Rows::Past => model.review.selected,
    }
}
