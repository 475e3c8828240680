//! Events, newest first: the pane of the mission screen, and the events screen.

use super::look::{Look, Parts, fill};
use super::small_map::{self, SmallMap};
use super::{event_detail, table, text};
use crate::model::log::filter::{Filter, without_least};
use crate::model::log::matches::Listed;
use crate::model::log::severity_word;
use crate::model::ui::Arrangement;
use crate::model::{Entry, Overlay, Pane};
use crate::theme::Role;
use crate::update::Rows;
use mission::Severity;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::Modifier;
use ratatui::text::Line;

/// Examples of filter terms.
const TERMS: &str = "   sev>=watch source=ae,tether station=C t>00:05 \"two words\" -text";
/// The minimum width at which each event states how long ago it happened, and the width of that column.
const AGED: usize = 100;
const AGE: usize = 11;
/// The minimum columns and rows of the screen at which the place of the selected event is shown beside the list, and
/// the width of the map for it.
const BESIDE: (u16, u16) = (170, 40);
const MAP: u16 = 72;
/// Minimum rows of the list beside the detail, including the frame.
const LIST: u16 = 7;

/// Draws the pane of the mission screen.
pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let ui = &look.model.ui;
    let needle = without_least(&ui.needle);
    let filter =
        if needle.is_empty() { String::new() } else { format!(", filter `{}`", text::fit(&needle, 16)) };
    let newer = ui.events.newer();
    let back = if newer > 0 { format!(", {newer} newer") } else { String::new() };
    let least = severity_word(ui.events.matches.filter().least());
    let title = format!("Events, {least} and above{filter}{back}");
    let note = match area.width {
        60.. if !ui.needle.is_empty() => "<severity> severity  <cancel> clear filter",
        60.. => "<severity> severity  <filter> filter",
        _ => "",
    };
    let block = look.pane(Pane::Events, &title, &look.keys(note));
    let inner = block.inner(area);
    let listed = ui.events.matches.newest(&look.run.log, newer).take(usize::from(inner.height));
    let lines = listed.map(|listed| look.line(listed_row(&listed, usize::from(inner.width))));
    fill(frame, area, block, nothing(look).into_iter().chain(lines).collect());
}

/// Why no event is listed, and what to do; `None` if one is.
fn nothing(look: &Look) -> Option<Line<'static>> {
    let ui = &look.model.ui;
    let needle = without_least(&ui.needle);
    let words = match needle.is_empty() {
        _ if !ui.events.matches.is_empty() => return None,
        true if ui.needle.is_empty() => "No events.".to_owned(),
        true => look.keys("No event is that severe. <cancel>: show all events."),
        false => format!(
            "No event matches `{}`. {}",
            text::fit(&needle, 30),
            look.keys("<cancel>: show all events.")
        ),
    };
    Some(look.line([(Role::Dim, format!(" {words}"))]))
}

/// Draws the events screen.
pub(crate) fn screen(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let events = &look.model.ui.events;
    let selected = events.selected().filter(|_| events.is_open);
    let open = selected.and_then(|number| Some((number, look.run.log.get(number)?)));
    let area = place(look, frame, area, selected.or_else(|| events.selected()));
    let Some((number, entry)) = open else { return list(look, frame, area) };
    if arrangement == Arrangement::Paged {
        return event_detail::draw(look, frame, area, (number, entry));
    }
    let rows = event_detail::rows(look, (number, entry), area.width).min(area.height.saturating_sub(LIST));
    let [above, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(rows)]).areas(area);
    list(look, frame, above);
    event_detail::draw(look, frame, below, (number, entry));
}

/// Draws the place of an event on a small map if there is room for one; returns the remaining area.
fn place(look: &Look, frame: &mut Frame, area: Rect, number: Option<u64>) -> Rect {
    let entry = number.and_then(|number| look.run.log.get(number));
    let map = SmallMap::of_run(look.run).filter(|_| area.width >= BESIDE.0 && area.height >= BESIDE.1);
    let Some((map, entry)) = map.zip(entry) else { return area };
    let [left, right] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(MAP)]).areas(area);
    let (map, title) = match look.run.place_of(&entry.what) {
        Some(at) => (map.marked(at, role(entry.severity), "X"), format!("Place  X {}", text::place(at))),
        None => (map, "This event has no place".to_owned()),
    };
    let block = look.block(Role::Border, &title, &format!("T+{}", text::clock(entry.t_s)));
    let inner = block.inner(right);
    frame.render_widget(block, right);
    small_map::draw(look, frame, inner, &map);
    left
}

fn list(look: &Look, frame: &mut Frame, area: Rect) {
    let events = &look.model.ui.events;
    let title = format!("Events  {} of {}, newest first", events.matches.len(), look.run.log.len());
    let shows_debug = events.matches.filter().shows_debug();
    let note = if shows_debug { "planner messages shown" } else { "planner messages hidden" };
    let note = if area.width >= 76 { note } else { "" };
    let block = look.block(Role::Focus, &title, note);
    let inner = block.inner(area);
    let columns = usize::from(inner.width);
    let mut lines = filter_lines(look, columns);
    lines.extend(nothing(look));
    let height = usize::from(inner.height).saturating_sub(lines.len());
    let newer = events.newer();
    let shown = table::window(newer, events.matches.len(), height);
    let below = Rect { y: inner.y + lines.len() as u16, height: height as u16, ..inner };
    table::place(look, below, Rows::Events, shown.clone());
    let listed = events.matches.newest(&look.run.log, shown.start).take(shown.len());
    lines.extend(listed.enumerate().map(|(index, listed)| {
        let age = if columns >= AGED { AGE } else { 0 };
        let mut parts = listed_row(&listed, columns.saturating_sub(1 + age));
        if age > 0 {
            let passed_s = look.run.clock.t_s - listed.entry.t_s;
            parts.insert(1, (Role::Dim, text::column(&format!("{:>6} ago", text::ago(passed_s)), age)));
        }
        table::row(look, parts, shown.start + index == newer, columns)
    }));
    fill(frame, area, block, lines);
    table::bar(look, frame, below, &shown, events.matches.len());
}

/// The filter with its invalid parts underlined, and why they are invalid; while the filter is being typed, examples
/// of terms.
fn filter_lines(look: &Look, columns: usize) -> Vec<Line<'static>> {
    let ui = &look.model.ui;
    let is_typed = matches!(ui.overlay, Overlay::Filter(_));
    if ui.needle.is_empty() && !is_typed {
        return Vec::new();
    }
    let filter = ui.events.matches.filter();
    let clear = if is_typed { "" } else { "<cancel>: clear  " };
    let mut line = look.line([(Role::Key, look.keys(&format!(" filter  {clear}")))]);
    line.spans.extend(pieces(&ui.needle, filter).into_iter().map(|(is_bad, piece)| {
        let span = look.span(if is_bad { Role::Warn } else { Role::Title }, piece);
        if is_bad { span.patch_style(Modifier::UNDERLINED) } else { span }
    }));
    let why = filter.problems.first().map(|problem| (Role::Warn, format!("   ^ {}", problem.why)));
    let hint = why.or_else(|| is_typed.then(|| (Role::Dim, TERMS.to_owned())));
    let hint = hint.map(|(role, text)| look.line([(role, text::fit(&text, columns))]));
    std::iter::once(line).chain(hint).collect()
}

/// Splits a filter into valid and invalid pieces.
fn pieces(text: &str, filter: &Filter) -> Vec<(bool, String)> {
    let mut pieces = Vec::new();
    let mut at = 0;
    for problem in &filter.problems {
        let (before, bad) = (text.get(at..problem.at.start), text.get(problem.at.clone()));
        pieces.push((false, before.unwrap_or_default().to_owned()));
        pieces.push((true, bad.unwrap_or_default().to_owned()));
        at = problem.at.end;
    }
    pieces.push((false, text.get(at..).unwrap_or_default().to_owned()));
    pieces
}

/// The role of a severity.
pub(super) fn role(severity: Severity) -> Role {
    match severity {
        Severity::Debug => Role::Dim,
        Severity::Info => Role::Text,
        Severity::Watch => Role::Watch,
        Severity::Warn => Role::Warn,
        Severity::Crit => Role::Crit,
    }
}

/// A listed line, cut to a given width, with the number of lines that are listed with it.
fn listed_row(listed: &Listed, columns: usize) -> Parts {
    let more = if listed.more > 0 { format!(" (+{} more)", listed.more) } else { String::new() };
    let mut parts = counted_row(listed.entry, listed.times, columns.saturating_sub(text::width(&more)));
    parts.push((Role::Dim, more));
    parts
}

/// A log line: as many clauses as fit in a given width.
pub(super) fn row(entry: &Entry, columns: usize) -> Parts {
    counted_row(entry, entry.count, columns)
}

fn counted_row(entry: &Entry, times: u32, columns: usize) -> Parts {
    let again = if times > 1 { format!(" (×{times})") } else { String::new() };
    let front = format!(" T+{} ", text::clock(entry.t_s));
    let source = text::column(&entry.source, 8);
    let severity = format!("{:<5}", severity_word(entry.severity));
    let room = columns.saturating_sub(text::width(&front) + 1 + 8 + severity.len() + text::width(&again) + 1);
    vec![
        (Role::Dim, front),
        (role(entry.severity), severity),
        (Role::Dim, format!(" {source}")),
        (Role::Text, text::clauses(&entry.text, room)),
        (Role::Dim, again),
    ]
}
