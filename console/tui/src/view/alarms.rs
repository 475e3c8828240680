//! The alarms pane of a large screen: one line per alarm, most severe first.

use super::alarm_screen::last_warnings;
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
    let (columns, height) = (usize::from(inner.width), usize::from(inner.height));
    if alarms.is_empty() {
        let none = vec![(Role::Dim, " No alarms.".to_owned())];
        let lines = std::iter::once(none).chain(warnings(look, columns, height.saturating_sub(1)));
        return fill(frame, area, block, lines.map(|row| look.line(row)).collect());
    }
    let each: Vec<Vec<Parts>> = alarms.iter().map(|alarm| rows(look, alarm, columns)).collect();
    let mut spare = height.saturating_sub(each.iter().map(Vec::len).sum());
    let mut lines = Vec::new();
    for (alarm, rows) in alarms.iter().zip(each) {
        // Rows that the alarms do not need say what is wrong.
        let words = text::wrap(&text::capitalized(&alarm.text), columns.saturating_sub(4));
        let about = if words.len() <= spare { words } else { Vec::new() };
        spare -= about.len();
        lines.extend(rows);
        lines.extend(about.into_iter().map(|words| vec![(Role::Dim, format!("   {words}"))]));
    }
    lines.extend(warnings(look, columns, spare));
    lines.truncate(height);
    fill(frame, area, block, lines.into_iter().map(|row| look.line(row)).collect());
}

/// The last warnings with their heading, in a number of rows; empty if not even one warning fits.
fn warnings(look: &Look, columns: usize, rows: usize) -> Vec<Parts> {
    let warnings = events::in_rows(last_warnings(look), (columns, rows.saturating_sub(1)));
    let heading = (!warnings.is_empty()).then(|| vec![(Role::Dim, " The last warnings:".to_owned())]);
    heading.into_iter().chain(warnings).collect()
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
