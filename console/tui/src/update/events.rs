//! The operator's actions on events.

use super::act::turn_to_pane;
use super::message::Effect;
use super::offer::{demand, on_screen, refuse};
use super::{place, typing};
use crate::model::log::filter::{with_debug, with_least};
use crate::model::{Model, Overlay, Pane, Screen};
use mission::Severity;

/// Updates the list of events for the current log and filter.
pub(super) fn refresh(model: &mut Model) {
    model.ui.events.matches.refresh(&model.ui.needle, &model.live.run.log);
}

/// Checks that an event is selected on the events screen.
pub(crate) fn is_selected(model: &Model) -> Result<(), String> {
    on_screen(model, Screen::Events)?;
    demand(!model.ui.events.matches.is_empty(), "no event is selected")
}

/// The label of Enter on the events screen: it goes to the details and back to the list. `None` without a selected event.
pub(crate) fn opens(model: &Model) -> Option<&'static str> {
    model.ui.events.selected()?;
    Some(if model.ui.focus() == Pane::Detail { "list" } else { "detail" })
}

/// Goes to the details of the selected event, or from there back to the list; from any other screen, goes to the details.
pub(crate) fn enter(model: &mut Model) -> Vec<Effect> {
    let Some(selected) = model.ui.events.selected() else {
        return refuse(model, "no event is selected".into());
    };
    let is_in_detail = model.ui.screen == Screen::Events && model.ui.focus() == Pane::Detail;
    // The open event stays selected while new ones arrive.
    model.ui.events.at = Some(selected);
    model.ui.go(Screen::Events);
    turn_to_pane(model, if is_in_detail { Pane::List } else { Pane::Detail });
    Vec::new()
}

/// Goes from the details of an event back to the list; returns whether the arrow keys applied to the details.
pub(super) fn close(model: &mut Model) -> bool {
    let is_in_detail = model.ui.focus() == Pane::Detail;
    let is_shown = model.ui.overlay == Overlay::None && model.ui.screen == Screen::Events && is_in_detail;
    if is_shown {
        turn_to_pane(model, Pane::List);
    }
    is_shown
}

/// Selects the next or previous event of the same kind.
pub(crate) fn next_like(model: &mut Model, back: bool) -> Vec<Effect> {
    let events = &mut model.ui.events;
    let next = events
        .selected()
        .and_then(|number| events.matches.next_like(&model.live.run.log, number, back, usize::MAX));
    match next {
        Some(next) => {
            events.at = Some(next);
            Vec::new()
        }
        None if back => refuse(model, "no earlier event of this kind".into()),
        None => refuse(model, "no later event of this kind".into()),
    }
}

/// Shows the position of the selected event on the map.
pub(crate) fn show_place(model: &mut Model) -> Vec<Effect> {
    let run = &model.live.run;
    let entry = model.ui.events.selected().and_then(|number| run.log.get(number));
    let shown = entry.and_then(|entry| Some((run.place_of(&entry.what)?, entry.text.clone())));
    match shown {
        Some((at, what)) => place::show(model, at, &what),
        None => refuse(model, "this event has no place on the map".into()),
    }
}

/// Copies the line of the selected event to the clipboard.
pub(crate) fn copy(model: &mut Model) -> Vec<Effect> {
    let entry = model.ui.events.selected().and_then(|number| model.live.run.log.get(number));
    let Some(line) = entry.map(crate::model::Entry::line) else {
        return refuse(model, "no event is selected".into());
    };
    model.say(Severity::Info, "line sent to the terminal's clipboard");
    vec![Effect::Copy(line)]
}

/// Changes the minimum severity, which is a term of the filter, to the next severity.
pub(crate) fn next_severity(model: &mut Model) {
    let filter = model.ui.events.matches.filter();
    let next = match filter.least() {
        Severity::Info => Severity::Watch,
        Severity::Watch => Severity::Warn,
        Severity::Warn => Severity::Crit,
        Severity::Debug | Severity::Crit => Severity::Info,
    };
    set_least(model, next);
}

/// Shows or hides the messages of planners about their own work.
pub(crate) fn toggle_debug(model: &mut Model) {
    let needle = &model.ui.needle;
    model.ui.needle = if model.ui.events.matches.filter().shows_debug() {
        with_least(needle, Severity::Info)
    } else {
        with_debug(needle)
    };
    model.ui.events.at = None;
    refresh(model);
}

/// Lists only events of the given severity or above.
pub(super) fn set_least(model: &mut Model, least: Severity) {
    model.ui.needle = with_least(&model.ui.needle, least);
    model.ui.events.at = None;
    refresh(model);
}

/// Opens the filter line; what is typed next becomes a separate term.
pub(crate) fn open_filter(model: &mut Model) -> Vec<Effect> {
    let mut text = typing::filtered(model).to_owned();
    if !text.is_empty() && model.ui.screen.row().filter.is_none() && !text.ends_with(' ') {
        text.push(' ');
    }
    model.ui.overlay = Overlay::Filter(text.as_str().into());
    Vec::new()
}
