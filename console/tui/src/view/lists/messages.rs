//! The history of messages, newest first.

use super::list::{List, hint, paragraph};
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
    let chosen = messages.iter().rev().nth(selected);
    let whole = chosen.into_iter().flat_map(|message| paragraph(Role::Text, &said(message), room));
    let mut below: Vec<Row> = std::iter::once(Row::new()).chain(whole).collect();
    if messages.is_empty() {
        below = vec![hint(" No messages yet.")];
    }
    List {
        title: format!("Messages  {}", messages.len()),
        note: "newest first".into(),
        above: vec![hint(" run        UTC      message")],
        rows: messages.iter().rev().map(|message| row(message, room)).collect(),
        selected,
        needed_below: below.len(),
        below,
        ..List::default()
    }
}

fn row(message: &Message, room: usize) -> Row {
    let run = message.t_s.map_or_else(|| "-".into(), |t_s| format!("T+{}", clock(t_s)));
    let day = clock(message.wall_unix_s.rem_euclid(DAY_S));
    let role = if message.severity == Severity::Info { Role::Text } else { events::role(message.severity) };
    let times = format!("{} {} ", text::column(&run, 10), text::column(&day, 8));
    let rest = room.saturating_sub(text::width(&times));
    vec![(Role::Dim, times), (role, text::fit(&said(message), rest))]
}

fn said(message: &Message) -> String {
    text::capitalized(&message.text)
}
