//! The rows of the alarm table.

use crate::guide;
use crate::model::Alarm;
use crate::model::alarms::{Reading, State};
use crate::model::log::severity_word;
use crate::model::ui::Arrangement;
use crate::theme::Role;
use crate::view::look::{Look, Parts};
use crate::view::{events, text};
use mission::Severity;

/// The widths of the columns; 0 for a column that is not shown.
struct Columns {
    /// The marks, and the word for the severity if the word fits.
    front: usize,
    state: usize,
    since: usize,
    count: usize,
    name: usize,
    now: usize,
    peak: usize,
    limit: usize,
}

/// Width of the table with all its columns.
pub(super) const WIDTH: u16 = 118;

/// The form of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// All columns, with full words.
    Wide,
    /// Short words.
    Narrow,
    /// Two lines per alarm, the name first.
    Double,
}

impl Form {
    pub(super) fn of(arrangement: Arrangement) -> Self {
        match arrangement {
            Arrangement::Wide => Self::Wide,
            Arrangement::Narrow => Self::Narrow,
            Arrangement::Paged | Arrangement::Strip => Self::Double,
        }
    }

    fn columns(self, room: usize) -> Columns {
        let at = match self {
            Self::Wide => {
                Columns { front: 10, state: 16, since: 15, count: 6, name: 0, now: 12, peak: 12, limit: 11 }
            }
            _ => Columns { front: 4, state: 8, since: 9, count: 4, name: 0, now: 11, peak: 0, limit: 11 },
        };
        let used = at.front + at.state + at.since + at.count + at.now + at.peak + at.limit;
        Columns { name: room.saturating_sub(used), ..at }
    }

    /// The column headings; `None` if the rows name their figures.
    pub(super) fn heads(self, room: usize) -> Option<String> {
        let at = self.columns(room);
        let right = |word: &str, columns: usize| match columns {
            0 => String::new(),
            columns => format!("{word:>width$} ", width = columns - 1),
        };
        let (severity, count) = match self {
            Self::Wide => ("    sev", "count"),
            Self::Narrow => ("", "n"),
            Self::Double => return None,
        };
        Some(
            [
                text::column(severity, at.front),
                text::column("state", at.state),
                text::column("since", at.since),
                right(count, at.count),
                text::column("what", at.name),
                right("now", at.now),
                right("peak", at.peak),
                right("limit", at.limit),
            ]
            .concat(),
        )
    }

    /// The lines of an alarm.
    pub(super) fn rows(self, look: &Look, alarm: &Alarm, room: usize) -> Vec<Parts> {
        match self {
            Self::Wide | Self::Narrow => vec![single(look, alarm, &self.columns(room), self == Self::Wide)],
            Self::Double => double(look, alarm, room),
        }
    }
}

/// The heading above the first alarm in a state; `None` for open alarms.
pub(super) fn heading(state: &State) -> Option<&'static str> {
    match state {
        State::Unacknowledged | State::Acknowledged | State::Returned => None,
        State::Shelved(_) => Some("shelved"),
        State::Cleared => Some("cleared in this run"),
    }
}

fn single(look: &Look, alarm: &Alarm, at: &Columns, wide: bool) -> Parts {
    let is_first = look.run.alarms.is_first_out(alarm);
    let since = match (wide, is_first) {
        (true, true) => format!("T+{} 1st", text::clock(alarm.since_s)),
        (true, false) => format!("T+{}", text::clock(alarm.since_s)),
        (false, _) => text::clock(alarm.since_s),
    };
    let count = if is_first && !wide { "1st".into() } else { alarm.count.to_string() };
    let word = if wide { severity_word(alarm.severity) } else { "" };
    let name = text::column(&text::wording(what(look, alarm), at.name), at.name);
    vec![
        (role(alarm), text::column(&format!("{} {word}", sign(alarm)), at.front - 1)),
        (Role::Text, text::column(&state(look, alarm, wide), at.state)),
        (Role::Dim, text::column(&since, at.since)),
        (Role::Dim, format!("{count:>width$} ", width = at.count - 1)),
        (Role::Text, name),
        now(alarm, at.now),
        (Role::Dim, right(&peak(alarm), at.peak)),
        (Role::Dim, right(&limit(alarm), at.limit)),
    ]
}

/// The name of an alarm with its state, and below it the figures with their names.
fn double(look: &Look, alarm: &Alarm, room: usize) -> Vec<Parts> {
    let state = state(look, alarm, false);
    // The mark of the selected row takes one column.
    let name = room.saturating_sub(5 + text::width(&state) + 1);
    let first = vec![
        (role(alarm), format!("{} ", sign(alarm))),
        (Role::Text, text::column(&text::fit(&short_name(look, alarm), name), name + 1)),
        (Role::Text, state),
    ];
    let times = if alarm.count > 1 { format!(" {}×", alarm.count) } else { String::new() };
    let now = match (&alarm.reading, alarm.is_active()) {
        (Some(reading), true) => format!(", now {}", reading.now),
        (Some(_), false) => format!(", now ok, peak {}", peak(alarm)),
        (None, _) => String::new(),
    };
    let limit = limit(alarm);
    let limit = if limit.is_empty() { limit } else { format!(", limit {limit}") };
    let figures = format!("   T+{}{times}{now}{limit}", text::clock(alarm.since_s));
    let room = room.saturating_sub(1);
    let mut rows = vec![first, vec![(Role::Dim, text::clauses(&figures, room))]];
    if let State::Shelved(shelf) = &alarm.state {
        let words = format!("shelved until T+{}: {}", text::clock(shelf.until_s), shelf.reason);
        let lines = text::wrap(&words, room.saturating_sub(3)).into_iter();
        rows.extend(lines.map(|line| vec![(Role::Dim, format!("   {line}"))]));
    }
    rows
}

/// The role of the severity of an alarm.
fn role(alarm: &Alarm) -> Role {
    if alarm.is_open() { events::role(alarm.severity) } else { Role::Dim }
}

/// A word, right-aligned in its column.
fn right(word: &str, columns: usize) -> String {
    match columns {
        0 => String::new(),
        columns => format!("{:>width$} ", text::fit(word, columns - 1), width = columns - 1),
    }
}

/// The figure that an alarm is about, as it is now.
fn now(alarm: &Alarm, columns: usize) -> (Role, String) {
    match &alarm.reading {
        _ if !alarm.is_active() => (Role::Dim, right("ok", columns)),
        Some(reading) => (Role::Text, right(&reading.now, columns)),
        None => (Role::Text, right("", columns)),
    }
}

/// The worst value while the cause persisted.
fn peak(alarm: &Alarm) -> String {
    alarm.peak.as_ref().map_or_else(String::new, |peak| peak.now.clone())
}

/// The limit of the alarm at its last value.
fn limit(alarm: &Alarm) -> String {
    let known = |reading: &&Reading| !reading.limit.is_empty();
    let readings = [alarm.reading.as_ref(), alarm.peak.as_ref()];
    readings.into_iter().flatten().find(known).map_or_else(String::new, |reading| reading.limit.clone())
}

/// The mark of an alarm that awaits acknowledgement, and the letter of its severity, as in the top line.
fn sign(alarm: &Alarm) -> String {
    let letter = match alarm.severity {
        Severity::Crit => 'C',
        Severity::Warn => 'W',
        Severity::Watch => 'w',
        Severity::Debug | Severity::Info => 'i',
    };
    format!("{}{letter}", if alarm.is_unacknowledged() { '!' } else { ' ' })
}

fn state(look: &Look, alarm: &Alarm, wide: bool) -> String {
    let word = match (&alarm.state, wide) {
        (State::Unacknowledged, true) => "ACTIVE, unack",
        (State::Acknowledged, true) => return acknowledged(alarm),
        (State::Returned, true) => "CLEARED, unack",
        (State::Unacknowledged, false) => "UNACK",
        (State::Acknowledged, false) => "ACK",
        (State::Returned, false) => "CLEARED",
        (State::Shelved(shelf), true) => return format!("until {}", text::clock(shelf.until_s)),
        (State::Shelved(_), false) => "SHELVED",
        (State::Cleared, true) => {
            let cleared_s = alarm.cleared_s.unwrap_or(alarm.since_s);
            return format!("{} ago", text::ago(look.run.clock.t_s - cleared_s));
        }
        (State::Cleared, false) => "",
    };
    word.to_owned()
}

/// The state of an acknowledged alarm, with the name of the person if it is short.
fn acknowledged(alarm: &Alarm) -> String {
    let by = alarm.acknowledged.as_ref().and_then(|seen| seen.by.as_deref());
    match by.filter(|by| text::width(by) <= 3) {
        Some(by) => format!("ACTIVE, ack {by}"),
        None => "ACTIVE, ack".to_owned(),
    }
}

/// The name of an alarm; that of a shelved one without the reason, which has its own line.
fn short_name(look: &Look, alarm: &Alarm) -> String {
    let [long, short] = what(look, alarm);
    if matches!(alarm.state, State::Shelved(_)) { short } else { long }
}

/// The name of an alarm, once with the reason why the alarm is shelved or with the time that it lasted, and once without
/// it.
fn what(look: &Look, alarm: &Alarm) -> [String; 2] {
    let name = guide::name(&alarm.cause, look.run);
    match &alarm.state {
        State::Shelved(shelf) => [format!("{name} ({})", shelf.reason), name],
        State::Cleared => match alarm.lasted_s() {
            Some(lasted_s) => [format!("{name} (lasted {})", text::ago(lasted_s)), name],
            None => [name.clone(), name],
        },
        _ => [name.clone(), name],
    }
}
