//! The rows of the alarm table.

use crate::guide;
use crate::model::Alarm;
use crate::model::alarms::State;
use crate::model::log::severity_word;
use crate::theme::Role;
use crate::view::look::{Look, Parts};
use crate::view::{events, text};
use mission::Severity;

/// The widths before and after the name of an alarm, columns.
struct Columns {
    /// The marks, and the word for the severity if the word fits.
    front: usize,
    state: usize,
    since: usize,
    count: usize,
    now: usize,
    limit: usize,
}

const WIDE: Columns = Columns { front: 10, state: 16, since: 15, count: 6, now: 13, limit: 11 };
const NARROW: Columns = Columns { front: 4, state: 8, since: 9, count: 4, now: 11, limit: 11 };

impl Columns {
    fn of(wide: bool) -> Self {
        if wide { WIDE } else { NARROW }
    }

    /// The columns left for the name.
    fn name(&self, columns: usize) -> usize {
        columns.saturating_sub(self.front + self.state + self.since + self.count + self.now + self.limit)
    }
}

/// The column headings of the table.
pub(super) fn heads(columns: usize, wide: bool) -> String {
    let at = Columns::of(wide);
    let right = |word: &str, columns: usize| format!("{word:>columns$}");
    [
        text::column(if wide { "    sev" } else { "" }, at.front),
        text::column("state", at.state),
        text::column("since", at.since),
        right(if wide { "count " } else { "n " }, at.count),
        text::column("what", at.name(columns)),
        right("now", at.now),
        right("limit", at.limit),
    ]
    .concat()
}

/// The heading above the first alarm in a state; `None` for open alarms.
pub(super) fn heading(state: &State) -> Option<&'static str> {
    match state {
        State::Unacknowledged | State::Acknowledged | State::Returned => None,
        State::Shelved(_) => Some("shelved"),
        State::Cleared => Some("cleared in this run"),
    }
}

pub(super) fn row(look: &Look, alarm: &Alarm, columns: usize, wide: bool) -> Parts {
    let at = Columns::of(wide);
    let role = if alarm.is_open() { events::role(alarm.severity) } else { Role::Dim };
    let reading = alarm.reading.clone().unwrap_or_default();
    let is_first = look.run.alarms.is_first_out(alarm);
    let since = match (wide, is_first) {
        (true, true) => format!("T+{} 1st", text::clock(alarm.since_s)),
        (true, false) => format!("T+{}", text::clock(alarm.since_s)),
        (false, _) => text::clock(alarm.since_s),
    };
    let count = if is_first && !wide { "1st".into() } else { alarm.count.to_string() };
    let word = if wide { severity_word(alarm.severity) } else { "" };
    let mark = if alarm.is_unacknowledged() { '!' } else { ' ' };
    vec![
        (role, text::column(&format!("{mark}{} {word}", letter(alarm.severity)), at.front - 1)),
        (Role::Text, text::column(&state(alarm, wide), at.state)),
        (Role::Dim, text::column(&since, at.since)),
        (Role::Dim, format!("{count:>width$} ", width = at.count - 1)),
        (Role::Text, text::column(&what(look, alarm), at.name(columns))),
        right_now(alarm, &reading.now, at.now),
        (Role::Dim, right(&reading.limit, at.limit)),
    ]
}

/// A word, right-aligned in its column.
fn right(word: &str, columns: usize) -> String {
    format!("{:>columns$}", text::fit(word, columns.saturating_sub(1)))
}

/// The figure that an alarm is about; once the cause is gone, the last value before that, marked as past.
fn right_now(alarm: &Alarm, last: &str, columns: usize) -> (Role, String) {
    if alarm.is_active() || last.is_empty() {
        return (Role::Text, right(last, columns));
    }
    let was = format!("was {last}");
    let fits = text::width(&was) < columns;
    (Role::Dim, right(if fits { &was } else { "over" }, columns))
}

/// The letter for a severity, as used in the top line.
fn letter(severity: Severity) -> char {
    match severity {
        Severity::Crit => 'C',
        Severity::Warn => 'W',
        Severity::Watch => 'w',
        Severity::Debug | Severity::Info => 'i',
    }
}

fn state(alarm: &Alarm, wide: bool) -> String {
    let word = match (&alarm.state, wide) {
        (State::Unacknowledged, true) => "ACTIVE, unack",
        (State::Acknowledged, true) => "ACTIVE, ack",
        (State::Returned, true) => "CLEARED, unack",
        (State::Unacknowledged, false) => "UNACK",
        (State::Acknowledged, false) => "ACK",
        (State::Returned, false) => "CLEARED",
        (State::Shelved(shelf), true) => return format!("until {}", text::clock(shelf.until_s)),
        (State::Shelved(_), false) => "SHELVED",
        (State::Cleared, true) => {
            let lasted_s = alarm.cleared_s.unwrap_or(alarm.since_s) - alarm.since_s;
            return format!("for {} s", text::number(lasted_s, 0));
        }
        (State::Cleared, false) => "",
    };
    word.to_owned()
}

fn what(look: &Look, alarm: &Alarm) -> String {
    let name = guide::name(&alarm.cause, look.run);
    match &alarm.state {
        State::Shelved(shelf) => format!("{name} ({})", shelf.reason),
        _ => name,
    }
}
