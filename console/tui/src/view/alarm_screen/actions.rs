//! The actions on an alarm.

use crate::guide::{Remedy, guide, name};
use crate::model::{Alarm, Cause, Overlay};
use crate::theme::Role;
use crate::update::offered;
use crate::view::lists::list::{List, paragraph};
use crate::view::look::{Look, Parts};
use crate::view::{table, text};
use ratatui::text::Line;

/// The keys that run the actions while the action list is open.
const NUMBERS: [&str; 4] = ["<first-action>", "<second-action>", "<third-action>", "<fourth-action>"];
/// Rows that a list cannot use: its frame, and the three lines that always stay visible.
const FRAME: usize = 5;

/// The actions, numbered; while the list is open, the selected action is marked.
pub(super) fn lines(look: &Look, alarm: &Alarm, columns: usize) -> Vec<Line<'static>> {
    let selected = match &look.model.ui.overlay {
        Overlay::Remedies { cause, selected } if *cause == alarm.cause => Some(*selected),
        _ => None,
    };
    let remedies = guide(&alarm.cause).remedies.iter().enumerate();
    remedies
        .flat_map(|(index, remedy)| {
            let is_selected = selected == Some(index);
            let rows = rows(look, index, remedy, columns.saturating_sub(1));
            let numbered = rows.into_iter().enumerate();
            numbered.map(move |(line, row)| table::row(look, row, is_selected && line == 0, columns))
        })
        .collect()
}

/// The actions as an overlay list, with cause and effect.
pub(in crate::view) fn list(look: &Look, cause: &Cause, selected: usize, columns: u16) -> List {
    let room = usize::from(columns).saturating_sub(3);
    let guide = guide(cause);
    let about = format!("{} {}", guide.cause, guide.effect);
    let remedies = guide.remedies.iter().enumerate();
    let spelled = |remedy: &Remedy| look.keys(remedy.text);
    let chosen = guide.remedies.get(selected).map_or_else(String::new, spelled);
    let text = |(index, remedy): (usize, &Remedy)| {
        vec![(role(look, remedy), text::fit(&format!("{} {}", number(look, index), spelled(remedy)), room))]
    };
    let mut below: Vec<Parts> = paragraph(Role::Text, &chosen, room).collect();
    below.extend(paragraph(Role::Dim, &about, room));
    // If space is short, the last lines about the alarm are dropped, never an action.
    let free = usize::from(look.model.ui.height).saturating_sub(FRAME + guide.remedies.len());
    below.truncate(free);
    List {
        title: name(cause, look.run),
        note: look.keys(super::RUN),
        rows: remedies.map(text).collect(),
        selected,
        below,
        ..List::default()
    }
}

fn rows(look: &Look, index: usize, remedy: &Remedy, columns: usize) -> Vec<Parts> {
    let role = role(look, remedy);
    let sentence = look.keys(remedy.text);
    let number = number(look, index);
    let width = text::width(&number) + 1;
    let wrapped = text::wrap(&sentence, columns.saturating_sub(width + 1));
    let front = |line: usize| text::column(if line == 0 { &number } else { "" }, width);
    let row = |(line, words)| vec![(Role::Key, front(line)), (role, words)];
    wrapped.into_iter().enumerate().map(row).collect()
}

fn number(look: &Look, index: usize) -> String {
    look.keys(NUMBERS.get(index).copied().unwrap_or_default())
}

/// Actions that cannot run now are dimmed.
fn role(look: &Look, remedy: &Remedy) -> Role {
    match remedy.action {
        Some(action) if offered(look.model, action).is_err() => Role::Dim,
        _ => Role::Text,
    }
}
