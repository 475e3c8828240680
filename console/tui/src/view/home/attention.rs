//! Problems that need attention, and checks that passed.

use super::border;
use super::pane::Pane;
use crate::model::home::{Attention, Found, HomeList};
use crate::theme::Role;
use crate::update::Rows;
use crate::view::look::{Look, Parts};
use crate::view::{events, text};
use mission::Severity;
use ratatui::Frame;
use ratatui::layout::Rect;

/// Width of the kind of an item, columns.
const KIND: usize = 12;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, (found, about): (&Found, bool)) {
    let home = &look.model.home;
    let is_focused = home.list == HomeList::Attention;
    let room = usize::from(area.width).saturating_sub(2);
    let open = found.attention.iter().filter(|point| point.severity > Severity::Info).count();
    let selected = look.model.home.selected_attention().filter(|_| is_read(look, about));
    let title = if open > 0 { "Attention" } else { "Checks" };
    let pane = Pane {
        border: border(look, HomeList::Attention),
        title,
        note: found
            .free_bytes
            .map_or_else(String::new, |bytes| format!("disk {} GB free", bytes / 1_000_000_000)),
        heads: None,
        rows: found.attention.iter().map(|point| row(point, room.saturating_sub(1))).collect(),
        selected: is_focused.then_some(home.attention),
        list: Rows::Attention,
        empty: " Nothing needs attention.".into(),
        about: selected.map(|point| (point.kind.clone(), whole(point, room))),
    };
    pane.draw(look, frame, area);
}

/// Whether the whole text of the selected item is shown below the list.
fn is_read(look: &Look, about: bool) -> bool {
    about && look.model.home.is_read && look.model.home.list == HomeList::Attention
}

/// The rows that the whole text of the selected item needs, with its title.
pub(super) fn text_rows(look: &Look, width: u16, about: bool) -> u16 {
    let room = usize::from(width).saturating_sub(2);
    let selected = look.model.home.selected_attention().filter(|_| is_read(look, about));
    selected.map_or(0, |point| whole(point, room).len() as u16 + 1)
}

/// The whole text of an item.
pub(super) fn whole(point: &Attention, columns: usize) -> Vec<Parts> {
    let lines = point.text.lines().flat_map(|line| text::wrap(line, columns.saturating_sub(2)));
    lines.map(|line| vec![(Role::Text, format!(" {line}"))]).collect()
}

/// The role of an item.
pub(super) fn role(point: &Attention) -> Role {
    if point.severity == Severity::Info { Role::Good } else { events::role(point.severity) }
}

fn row(point: &Attention, columns: usize) -> Parts {
    let first = point.text.lines().next().unwrap_or_default();
    vec![
        (role(point), text::column(&text::fit(&point.kind, KIND - 1), KIND)),
        (Role::Text, text::clauses(first, columns.saturating_sub(KIND))),
    ]
}
