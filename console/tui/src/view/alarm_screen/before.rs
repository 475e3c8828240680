//! Log lines that are not about an alarm: those before the selected alarm, or the last warnings.

use crate::model::Alarm;
use crate::model::log::Entry;
use crate::theme::Role;
use crate::view::events;
use crate::view::look::{Look, fill};
use mission::Severity;
use ratatui::Frame;
use ratatui::layout::Rect;

/// The number of log lines among which the last warnings are looked for in each frame.
const LOOKED_AT: usize = 5000;
/// The number of last warnings that are shown where other figures need the room.
const MOST: usize = 6;

/// The log lines up to the last event of an alarm, newest first: what led to the alarm.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, alarm: &Alarm) {
    list(look, frame, area, "Events before it", before(look, alarm));
}

fn before<'a>(look: &Look<'a>, alarm: &Alarm) -> impl Iterator<Item = &'a Entry> {
    let (log, last) = (&look.run.log, alarm.events.back().copied());
    let numbers = last.map_or(0..0, |last| log.oldest()..last);
    let shown = numbers.rev().filter_map(|number| log.get(number));
    shown.filter(|entry| entry.severity >= Severity::Info)
}

/// The rows, including the frame, in which the lines before an alarm are shown whole; at most those of the area.
pub(super) fn rows(look: &Look, area: Rect, alarm: &Alarm) -> u16 {
    let size = (usize::from(area.width.saturating_sub(2)), usize::from(area.height.saturating_sub(2)));
    events::in_rows(before(look, alarm), size).len().max(1) as u16 + 2
}

/// The last log lines of WATCH and above, newest first.
pub(in crate::view) fn last_warnings<'a>(look: &Look<'a>) -> impl Iterator<Item = &'a Entry> {
    let log = &look.run.log;
    let numbers = (log.oldest()..log.end()).rev().take(LOOKED_AT);
    numbers.filter_map(|number| log.get(number)).filter(|entry| entry.severity >= Severity::Watch)
}

/// Draws the last warnings.
pub(super) fn warnings(look: &Look, frame: &mut Frame, area: Rect) {
    list(look, frame, area, "Last warnings", last_warnings(look));
}

/// The rows that the last warnings need, including the frame: at most those for [`MOST`] of them.
pub(super) fn warning_rows(look: &Look) -> u16 {
    last_warnings(look).take(MOST).count().max(1) as u16 + 2
}

fn list<'a>(
    look: &Look,
    frame: &mut Frame,
    area: Rect,
    title: &str,
    entries: impl Iterator<Item = &'a Entry>,
) {
    let block = look.block(Role::Border, title, &look.keys("<events> all events"));
    let inner = block.inner(area);
    let size = (usize::from(inner.width), usize::from(inner.height));
    let mut lines: Vec<_> =
        events::in_rows(entries, size).into_iter().map(|parts| look.line(parts)).collect();
    if lines.is_empty() {
        lines.push(look.line([(Role::Dim, " None.".to_owned())]));
    }
    fill(frame, area, block, lines);
}
