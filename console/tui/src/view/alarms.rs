//! The alarms pane of a large screen: one line per alarm, most severe first.

use super::look::{Look, Parts, fill};
use super::{events, text};
use crate::guide;
use crate::model::log::severity_word;
use crate::model::{Alarm, Pane};
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::Rect;

/// The minimum width at which an alarm takes one line, columns.
const BESIDE: usize = 64;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let mut alarms = look.run.alarms.table();
    alarms.retain(|alarm| alarm.is_open());
    let block = look.pane(
        Pane::Alarms,
        &format!("Alarms  {}", alarms.len()),
        &look.keys("<acknowledge> acknowledge  <alarms> all"),
    );
    let inner = block.inner(area);
    let mut lines: Vec<_> = alarms
        .iter()
        .flat_map(|alarm| rows(look, alarm, usize::from(inner.width)))
        .take(usize::from(inner.height))
        .map(|row| look.line(row))
        .collect();
    if lines.is_empty() {
        lines.push(look.line([(Role::Dim, " No alarms.".into())]));
    }
    fill(frame, area, block, lines);
}

/// The rows of an alarm: state first, then the text beside it or, in a narrow pane, below it.
fn rows(look: &Look, alarm: &Alarm, columns: usize) -> Vec<Parts> {
    let state = match (alarm.is_active(), alarm.is_unacknowledged()) {
        (true, false) => "ack",
        (true, true) => "UNACK",
        (false, _) => "cleared",
    };
    let severity = (events::role(alarm.severity), format!(" {:<5}", severity_word(alarm.severity)));
    let front = (Role::Dim, format!(" {state:<7} T+{} ", text::clock(alarm.since_s)));
    let name = guide::name(&alarm.cause, look.run);
    let reading = alarm.reading.as_ref().filter(|_| alarm.is_active());
    let words = reading.map_or_else(|| name.clone(), |reading| format!("{name}: {}", reading.now));
    let words = |room: usize| (Role::Text, text::fit(&words, room));
    let used = text::width(&severity.1) + text::width(&front.1);
    if columns >= BESIDE {
        vec![vec![severity, front, words(columns - used)]]
    } else {
        vec![vec![severity, front], vec![(Role::Text, "   ".into()), words(columns.saturating_sub(3))]]
    }
}
