//! The details of one event, in words.

mod facts;

use super::fields::{self, Field};
use super::look::Look;
use super::{scroll, text};
use crate::model::alarms::State;
use crate::model::{Cause, Entry};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Width of the figure names, columns.
const NAMES: usize = 12;
/// The number of earlier planner messages shown with the last one.
const ALSO: usize = 8;
/// How many lines are searched for an event of the same kind, in every frame.
const NEAR: usize = 2000;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, (number, entry): (u64, &Entry)) {
    let title = format!("T+{}.{}  {}", text::clock(entry.t_s), tenths(entry.t_s), facts::title(&entry.what));
    let note = "<show-place> map  <copy> copy  <next-like> <previous-like> same kind";
    let note = if area.width >= 70 { look.keys(note) } else { String::new() };
    let columns = usize::from(area.width.saturating_sub(2));
    scroll::draw(look, frame, area, (&title, &note), lines(look, (number, entry), columns));
}

/// The rows that the detail needs, including the frame.
pub(super) fn rows(look: &Look, event: (u64, &Entry), width: u16) -> u16 {
    lines(look, event, usize::from(width.saturating_sub(2))).len() as u16 + 2
}

fn tenths(t_s: f64) -> u64 {
    if t_s.is_finite() { (t_s.max(0.0) * 10.0 + 1e-6) as u64 % 10 } else { 0 }
}

fn lines(look: &Look, (number, entry): (u64, &Entry), columns: usize) -> Vec<Line<'static>> {
    let mut all: Vec<Field> = vec![("event", text::capitalized(&entry.text))];
    all.extend(facts::facts(look.run, entry));
    let also = look.model.ui.events.matches.grouped(&look.run.log, number).take(ALSO);
    all.extend(also.map(|entry| ("before", text::capitalized(&entry.text))));
    all.extend(alarm(look, entry));
    all.extend(same_kind(look, number));
    let again = if entry.count > 1 { format!(", {} times in a row", entry.count) } else { String::new() };
    all.push(("journal", format!("tick {}{again}", entry.tick)));
    fields::lines(look, &all, NAMES, columns)
}

/// The current state of the alarm to which the event belongs.
fn alarm(look: &Look, entry: &Entry) -> Option<Field> {
    let cause = Cause::of(&entry.what.event()?.kind)?;
    let alarm = look.run.alarms.get(&cause)?;
    let state = match &alarm.state {
        State::Unacknowledged => "active, not acknowledged",
        State::Acknowledged => "active, acknowledged",
        State::Returned => "cleared, not acknowledged",
        State::Shelved(_) => "shelved",
        State::Cleared => "cleared",
    };
    Some(("alarm", state.to_owned()))
}

fn same_kind(look: &Look, number: u64) -> Option<Field> {
    let (matches, log) = (&look.model.ui.events.matches, &look.run.log);
    let at = |back, word: &str| {
        let entry = log.get(matches.next_like(log, number, back, NEAR)?)?;
        Some(format!("{word} T+{}", text::clock(entry.t_s)))
    };
    let words: Vec<String> = at(true, "previous").into_iter().chain(at(false, "next")).collect();
    (!words.is_empty()).then(|| ("same kind", words.join(", ")))
}
