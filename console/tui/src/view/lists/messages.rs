//! The history of messages, newest first.

use super::list::{List, hint};
use crate::model::{Message, log::clock};
use crate::theme::Role;
use crate::view::look::{Look, Parts as Row};
use crate::view::{events, text};
use mission::Severity;

/// Seconds in a day.
const DAY_S: f64 = 86_400.0;

pub(super) fn list(look: &Look, selected: usize, columns: u16) -> List {
    let messages = &look.model.console.messages;
    let room = usize::from(columns).saturating_sub(3);
    let entries: Vec<Vec<Row>> = messages.iter().rev().map(|message| rows(message, room)).collect();
    let first = entries.iter().take(selected).map(Vec::len).sum();
    let selected_rows = entries.get(selected).map_or(1, Vec::len);
    // The lines after the first one of a message are not counted.
    let mut headings = Vec::new();
    let mut at = 0;
    for entry in &entries {
        headings.extend(at + 1..at + entry.len());
        at += entry.len();
    }
    let below = if messages.is_empty() { vec![hint(" No messages yet.")] } else { Vec::new() };
    List {
        title: format!("Messages  {}", messages.len()),
        note: "newest first".into(),
        above: vec![hint(" run        UTC      message")],
        rows: entries.concat(),
        headings,
        selected: first,
        selected_rows,
        needed_below: below.len(),
        below,
        ..List::default()
    }
}

/// A message in as many rows as it needs.
fn rows(message: &Message, room: usize) -> Vec<Row> {
    let run = message.t_s.map_or_else(|| "-".into(), |t_s| format!("T+{}", clock(t_s)));
    let day = clock(message.wall_unix_s.rem_euclid(DAY_S));
    let role = if message.severity == Severity::Info { Role::Text } else { events::role(message.severity) };
    let times = format!("{} {} ", text::column(&run, 10), text::column(&day, 8));
    let rest = room.saturating_sub(text::width(&times));
    let indent = " ".repeat(text::width(&times));
    let lines = text::wrap(&text::capitalized(&message.text), rest).into_iter().enumerate();
    lines
        .map(|(line, words)| {
            let front = if line == 0 { times.clone() } else { indent.clone() };
            vec![(Role::Dim, front), (role, words)]
        })
        .collect()
}
