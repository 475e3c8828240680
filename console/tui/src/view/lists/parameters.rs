//! The list of planner parameters, and the input line for a value.

use super::list::{List, hint, paragraph};
use crate::model::{parameter, ui::Edit};
use crate::theme::Role;
use crate::view::field::field;
use crate::view::look::{Look, Parts as Row};
use crate::view::text;

pub(super) fn list(look: &Look, selected: usize, edit: Option<&Edit>, columns: u16) -> List {
    let Some((planner, choice)) = look.model.edited() else {
        return List { title: "Parameters".into(), ..List::default() };
    };
    let room = usize::from(columns).saturating_sub(3);
    // A narrow list omits the defaults.
    let (name, value, default, unit) = match columns {
        100.. => (24, 26, 27, 12),
        74.. => (20, 13, 16, 10),
        56.. => (16, 9, 12, 8),
        _ => (14, 9, 0, 8),
    };
    let rows = planner.parameters.iter().map(|info| {
        let (now, unset) = (parameter::value(choice, info), parameter::default(&info.kind));
        let changed = if now == unset { " " } else { "*" };
        vec![
            (Role::Text, spaced(&info.key, name)),
            (Role::Title, format!("{}{changed} ", text::column(&now.to_string(), value))),
            (Role::Dim, spaced(&unset.to_string(), default)),
            (Role::Dim, spaced(parameter::unit(info), unit)),
            (Role::Dim, if info.live { "any time" } else { "held" }.into()),
        ]
    });
    let head = [
        text::column("name", name),
        text::column("value", value + 2),
        text::column("default", default),
        text::column("unit", unit),
        "set when".into(),
    ];
    let mut below = Vec::new();
    let mut needed_below = 0;
    let mut cursor = None;
    if let Some(info) = planner.parameters.get(selected) {
        if let Some(edit) = edit {
            let (rows, column) = edit_rows(info, edit, room);
            below.extend(rows);
            // The first line below the table's heading.
            cursor = Some((1, column));
        }
        // The error already states the range.
        if edit.is_none_or(|edit| edit.refusal.is_none()) {
            let (now, unset) = (parameter::value(choice, info), parameter::default(&info.kind));
            let allowed = format!("{} {now}, default {unset}, allowed: {}", info.key, parameter::range(info));
            below.extend(paragraph(Role::Dim, &allowed, room));
        }
        let about = format!("{}. {}", info.label, info.help);
        below.extend(paragraph(Role::Text, &about, room));
        // While a value is being typed, the texts of its parameter take precedence over other parameters.
        needed_below = if edit.is_some() { below.len() } else { 0 };
    }
    let is_draft = look.model.live.what_if.as_ref().is_some_and(|what_if| what_if.draft.is_some());
    let what = if is_draft { "Forecast with parameters" } else { "Parameters" };
    List {
        title: format!("{what} of {} {}", planner.id, planner.version),
        note: "* changed".into(),
        above: vec![hint(&format!(" {}", head.concat()))],
        rows: rows.collect(),
        selected,
        below,
        needed_below,
        cursor,
        ..List::default()
    }
}

/// A table cell that ends with a space, so that it does not touch the next cell.
fn spaced(cell: &str, columns: usize) -> String {
    text::column(&text::fit(cell, columns.saturating_sub(1)), columns)
}

/// The input line for the value with its error, if there is one, and the column of the cursor.
fn edit_rows(info: &mission::ParamInfo, edit: &Edit, room: usize) -> (Vec<Row>, usize) {
    let name = format!(" {} = ", info.key);
    let shown = field(&edit.line, room.saturating_sub(text::width(&name) + 1));
    let typed = vec![(Role::Confirm, text::fit(&format!("{name}{} ", shown.text), room))];
    let why = edit.refusal.iter().flat_map(|why| paragraph(Role::Warn, &format!("REFUSED: {why}"), room));
    ([typed].into_iter().chain(why).collect(), text::width(&name) + shown.cursor)
}
