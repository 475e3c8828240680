//! The table of alarms.

use super::rows::{self, Form};
use crate::actions::ActionId;
use crate::model::alarms::State;
use crate::model::ui::Arrangement;
use crate::model::{Alarm, Pane};
use crate::theme::Role;
use crate::update::{Rows, offered};
use crate::view::look::{Look, fill};
use crate::view::table;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// The rows that the table needs, including the frame.
pub(super) fn rows(look: &Look, arrangement: Arrangement) -> u16 {
    lines(look, 80, Form::of(arrangement)).0.len() as u16 + 2
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let inner = look.block(Role::Focus, "", "").inner(area);
    let (columns, height) = (usize::from(inner.width), usize::from(inner.height));
    let (lines, places) = lines(look, columns, Form::of(arrangement));
    let chosen = look.model.selected_alarm().map(|alarm| &alarm.cause);
    let table = look.run.alarms.table();
    let selected = table.iter().position(|alarm| chosen == Some(&alarm.cause)).unwrap_or(0);
    let line = places.get(selected).copied().unwrap_or(0);
    // The other lines of a row must not be cut off.
    let last = places.get(selected + 1).map_or(lines.len(), |next| *next).saturating_sub(1).max(line);
    let shown = table::window(last.min(line + height.saturating_sub(1)), lines.len(), height);
    let visible: Vec<usize> = (0..places.len()).filter(|index| shown.contains(&places[*index])).collect();
    for index in &visible {
        let row = Rect { y: inner.y + (places[*index] - shown.start) as u16, height: 1, ..inner };
        table::place(look, row, Rows::Alarms, *index..index + 1);
    }
    let range = visible.first().map_or(0..0, |first| *first..first + visible.len());
    let title = title(&table, &range);
    let block = look.pane(Pane::List, &title, &note(look, arrangement));
    let lines = lines.into_iter().enumerate().filter(|(index, _)| shown.contains(index));
    fill(frame, area, block, lines.map(|(_, line)| line).collect());
}

/// The number of alarms, which of them are visible, and how many are in each state.
fn title(table: &[&Alarm], visible: &std::ops::Range<usize>) -> String {
    let count = |is: fn(&State) -> bool| table.iter().filter(|alarm| is(&alarm.state)).count();
    let shelved = count(|state| matches!(state, State::Shelved(_)));
    let cleared = count(|state| *state == State::Cleared);
    let open = table.len() - shelved - cleared;
    let shown = table::counted(visible, table.len());
    format!("Alarms  {shown}: {open} open, {shelved} shelved, {cleared} cleared")
}

/// The actions on all alarms that are possible now.
fn note(look: &Look, arrangement: Arrangement) -> String {
    if arrangement != Arrangement::Wide {
        return String::new();
    }
    let actions = [
        (ActionId::AcknowledgeAll, "<acknowledge-all> acknowledge all"),
        (ActionId::Shelve, "<shelve> shelve"),
    ];
    let possible = actions.into_iter().filter(|(id, _)| offered(look.model, *id).is_ok());
    let words: Vec<String> = possible.map(|(_, words)| look.keys(words)).collect();
    words.join("  ")
}

/// All lines of the table, and the first line of each alarm.
fn lines(look: &Look, columns: usize, form: Form) -> (Vec<Line<'static>>, Vec<usize>) {
    let alarms = look.run.alarms.table();
    let mut lines: Vec<Line> =
        form.heads(columns).into_iter().map(|heads| look.line([(Role::Dim, heads)])).collect();
    if !alarms.iter().any(|alarm| alarm.is_open()) {
        lines.push(look.line([(Role::Good, " No open alarms.".into())]));
    }
    let chosen = look.model.selected_alarm().map(|alarm| &alarm.cause);
    let mut group = None;
    let mut places = Vec::new();
    for alarm in &alarms {
        let heading = rows::heading(&alarm.state);
        if heading != group {
            group = heading;
            let number = alarms.iter().filter(|other| rows::heading(&other.state) == heading).count();
            lines.push(look.line([(Role::Dim, format!("   {} {number}", heading.unwrap_or_default()))]));
        }
        places.push(lines.len());
        let is_selected = chosen == Some(&alarm.cause);
        let rows = form.rows(look, alarm, columns).into_iter().enumerate();
        lines.extend(rows.map(|(line, row)| table::row(look, row, is_selected && line == 0, columns)));
    }
    (lines, places)
}
