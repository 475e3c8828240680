//! The alarm screen: alarms, their causes, and possible actions.

mod actions;
mod detail;
mod rows;

pub(super) use actions::list as action_list;

use super::look::{Look, fill};
use super::{events, table};
use crate::model::alarms::State;
use crate::model::ui::Arrangement;
use crate::model::{Alarm, Model, Overlay, Screen};
use crate::theme::Role;
use crate::update::Rows;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;

/// Width of the detail pane when the actions are beside it, columns.
const DETAIL: u16 = 72;
/// Rows of the pane with an alarm's events, including the frame.
const EVENTS: u16 = 5;
/// The keys that run the actions in the open list.
const RUN: &str = "<first-action>-<fourth-action> run";
/// Minimum rows of the table, including the frame.
const TABLE: u16 = 7;

pub(crate) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    match (look.model.selected_alarm(), arrangement) {
        (Some(alarm), Arrangement::Wide) => wide(look, frame, area, alarm),
        (Some(alarm), Arrangement::Narrow) => narrow(look, frame, area, alarm),
        _ => draw_table(look, frame, area, false),
    }
}

/// Whether the screen itself shows the actions, so that no overlay is needed.
pub(super) fn shows_actions(model: &Model) -> bool {
    let whole = matches!(model.ui.arrangement(), Arrangement::Wide | Arrangement::Narrow);
    whole && model.ui.screen == Screen::Alarms
}

fn wide(look: &Look, frame: &mut Frame, area: Rect, alarm: &Alarm) {
    let columns = usize::from(DETAIL) - 2;
    let detail = detail::lines(look, alarm, columns);
    let actions = actions::lines(look, alarm, usize::from(area.width.saturating_sub(DETAIL)) - 2);
    let rows = detail.len().max(actions.len()) as u16 + 2;
    let rows = rows.min(area.height.saturating_sub(EVENTS + TABLE));
    let [list, middle, below] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(rows), Constraint::Length(EVENTS)])
            .areas(area);
    let [left, right] = Layout::horizontal([Constraint::Length(DETAIL), Constraint::Fill(1)]).areas(middle);
    draw_table(look, frame, list, true);
    let map = alarm.place.map_or_else(String::new, |_| look.keys("<show-place> map"));
    fill(frame, left, look.block(Role::Border, &detail::title(look, alarm), &map), detail);
    fill(frame, right, actions_block(look, "Actions"), actions);
    let block = look.block(Role::Border, "Events of this alarm", &look.keys("<events> all events"));
    fill(frame, below, block, of_alarm(look, alarm, usize::from(below.width) - 2));
}

fn narrow(look: &Look, frame: &mut Frame, area: Rect, alarm: &Alarm) {
    let columns = usize::from(area.width) - 2;
    let actions = actions::lines(look, alarm, columns);
    let rows = usize::from(area.height.saturating_sub(TABLE + 2)).saturating_sub(actions.len());
    let mut lines = detail::lines(look, alarm, columns);
    lines.truncate(rows);
    lines.extend(actions);
    let rows = lines.len() as u16 + 2;
    let [list, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(rows)]).areas(area);
    draw_table(look, frame, list, false);
    fill(frame, below, actions_block(look, &detail::title(look, alarm)), lines);
}

fn actions_block<'t>(look: &Look, title: &str) -> ratatui::widgets::Block<'t> {
    let is_open = matches!(look.model.ui.overlay, Overlay::Remedies { .. });
    let (border, note) = if is_open {
        (Role::Focus, RUN)
    } else {
        (Role::Border, "<accept>, then <first-action>-<fourth-action>")
    };
    look.block(border, title, &look.keys(note))
}

/// The last log lines about an alarm, newest first.
fn of_alarm(look: &Look, alarm: &Alarm, columns: usize) -> Vec<Line<'static>> {
    let entries = alarm.events.iter().rev().filter_map(|number| look.run.log.get(*number));
    entries.take(usize::from(EVENTS) - 2).map(|entry| look.line(events::row(entry, columns))).collect()
}

fn draw_table(look: &Look, frame: &mut Frame, area: Rect, wide: bool) {
    let alarms = look.run.alarms.table();
    let count = |is: fn(&State) -> bool| alarms.iter().filter(|alarm| is(&alarm.state)).count();
    let shelved = count(|state| matches!(state, State::Shelved(_)));
    let cleared = count(|state| *state == State::Cleared);
    let open = alarms.len() - shelved - cleared;
    let title = format!("Alarms  {open} open, {shelved} shelved, {cleared} cleared");
    let block = look.block(
        Role::Focus,
        &title,
        &if wide { look.keys("<acknowledge-all> acknowledge all  <shelve> shelve") } else { String::new() },
    );
    let inner = block.inner(area);
    let (columns, height) = (usize::from(inner.width), usize::from(inner.height));
    let mut lines = vec![look.line([(Role::Dim, rows::heads(columns, wide))])];
    if open == 0 {
        lines.push(look.line([(Role::Good, " No open alarms.".into())]));
    }
    let mut selected = 0;
    let chosen = look.model.selected_alarm().map(|alarm| &alarm.cause);
    let mut group = None;
    let mut places = Vec::new();
    for alarm in alarms {
        let heading = rows::heading(&alarm.state);
        if heading != group {
            group = heading;
            let number = if alarm.state == State::Cleared { cleared } else { shelved };
            lines.push(look.line([(Role::Dim, format!("   {} {number}", heading.unwrap_or_default()))]));
        }
        let is_selected = chosen == Some(&alarm.cause);
        if is_selected {
            selected = lines.len();
        }
        places.push(lines.len());
        lines.push(table::row(look, rows::row(look, alarm, columns, wide), is_selected, columns));
    }
    let shown = table::window(selected, lines.len(), height);
    for (index, line) in places.into_iter().enumerate().filter(|(_, line)| shown.contains(line)) {
        let row = Rect { y: inner.y + (line - shown.start) as u16, height: 1, ..inner };
        table::place(look, row, Rows::Alarms, index..index + 1);
    }
    let lines = lines.into_iter().enumerate().filter(|(index, _)| shown.contains(index));
    fill(frame, area, block, lines.map(|(_, line)| line).collect());
}
