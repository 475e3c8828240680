//! Events, newest first: the pane of the mission screen, and the events screen.

use super::look::{Look, Parts, fill};
use super::scroll::{self, Extent};
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
use ratatui::text::{Line, Span};

/// Examples of filter terms.
const TERMS: &str = "sev>=watch source=ae,tether station=C t>00:05 \"two words\" -text";
/// The front of the line with the filter.
const FILTER: &str = " filter  ";
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

/// The parts of the events screen.
struct Divided<'a> {
    list: Option<Rect>,
    /// The selected event with its number, and the area for its details.
    detail: Option<(Rect, (u64, &'a Entry))>,
    /// The map with the place of the event, if there is room for it.
    map: Option<(Rect, SmallMap<'a>)>,
}

/// Divides the screen. The details of the selected event are below the list; a small screen shows one of them at a time.
fn divided<'a>(look: &Look<'a>, area: Rect) -> Divided<'a> {
    let ui = &look.model.ui;
    let selected = ui.events.selected().and_then(|number| Some((number, look.run.log.get(number)?)));
    let Some(event) = selected else { return Divided { list: Some(area), detail: None, map: None } };
    if ui.arrangement() == Arrangement::Paged {
        let is_list = ui.focus() == Pane::List;
        return Divided { list: is_list.then_some(area), detail: Some((area, event)), map: None };
    }
    let map = SmallMap::of_run(look.run, look.model.live.together());
    let map = map.filter(|_| area.width >= BESIDE.0 && area.height >= BESIDE.1);
    let beside = if map.is_some() { MAP } else { 0 };
    let [left, right] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(beside)]).areas(area);
    // While the arrow keys apply to the list, it keeps at least half of the rows.
    let most = if ui.focus() == Pane::Detail { LIST } else { left.height.div_ceil(2) };
    let rows = event_detail::rows(look, event, left.width).min(left.height.saturating_sub(most));
    let [above, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(rows)]).areas(left);
    Divided { list: Some(above), detail: Some((below, event)), map: map.map(|map| (right, map)) }
}

/// Draws the events screen.
pub(crate) fn screen(look: &Look, frame: &mut Frame, area: Rect, _: Arrangement) {
    let divided = divided(look, area);
    if let Some(area) = divided.list {
        list(look, frame, area);
    }
    if let Some((area, event)) = divided.detail.filter(|(area, _)| divided.list != Some(*area)) {
        event_detail::draw(look, frame, area, event);
        if let Some((area, map)) = divided.map {
            place(look, frame, area, (map, event.1));
        }
    }
}

/// How much of the details of the selected event is visible.
pub(crate) fn extent(look: &Look, area: Rect) -> Option<Extent> {
    let (area, event) = divided(look, area).detail?;
    let rows = event_detail::rows(look, event, area.width).saturating_sub(2);
    Some(scroll::extent(area, rows.into()))
}

/// Draws the place of an event on a small map.
fn place(look: &Look, frame: &mut Frame, area: Rect, (map, entry): (SmallMap, &Entry)) {
    let (map, title) = match look.run.place_of(&entry.what) {
        Some(at) => (map.marked(at, role(entry.severity), "X"), format!("Place  X {}", text::place(at))),
        None => (map, "This event has no place".to_owned()),
    };
    let block = look.block(Role::Border, &title, &format!("T+{}", text::clock(entry.t_s)));
    let inner = block.inner(area);
    frame.render_widget(block, area);
    small_map::draw(look, frame, inner, &map);
}

fn list(look: &Look, frame: &mut Frame, area: Rect) {
    let events = &look.model.ui.events;
    let title = format!("Events  {} of {}, newest first", events.matches.len(), look.run.log.len());
    let shows_debug = events.matches.filter().shows_debug();
    let note = if shows_debug { "planner messages shown" } else { "planner messages hidden" };
    let note = if area.width >= 76 { note } else { "" };
    let block = look.pane(Pane::List, &title, note);
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
    let clear = if is_typed { String::new() } else { look.keys("<cancel>: clear  ") };
    let whole = text::width(&ui.needle) + text::width(&clear) + text::width(FILTER);
    let clear = if whole > columns { String::new() } else { clear };
    let front = look.span(Role::Key, format!("{FILTER}{clear}"));
    let pieces = pieces(&ui.needle, filter).into_iter().map(|(is_bad, piece)| {
        let span = look.span(if is_bad { Role::Warn } else { Role::Title }, piece);
        if is_bad { span.patch_style(Modifier::UNDERLINED) } else { span }
    });
    let lines = broken(std::iter::once(front).chain(pieces), columns);
    let why = filter.problems.first().map(|problem| (Role::Warn, format!("^ {}", problem.why)));
    let hint = why.or_else(|| is_typed.then(|| (Role::Dim, TERMS.to_owned())));
    let hints = hint.into_iter().flat_map(|(role, words)| {
        let lines = text::wrap(&words, columns.saturating_sub(3)).into_iter();
        lines.map(move |line| (role, format!("   {line}")))
    });
    let hints: Vec<Line> = hints.map(|part| look.line([part])).collect();
    lines.into_iter().chain(hints).collect()
}

/// Spans in lines of a width; the lines after the first one are indented.
fn broken(spans: impl Iterator<Item = Span<'static>>, columns: usize) -> Vec<Line<'static>> {
    let indent = text::width(FILTER);
    let (mut lines, mut used) = (vec![Line::default()], 0);
    for span in spans {
        for letter in span.content.chars() {
            let width = text::width(&letter.to_string());
            if used + width > columns {
                lines.push(Line::from(" ".repeat(indent)));
                used = indent;
            }
            used += width;
            if let Some(line) = lines.last_mut() {
                line.push_span(Span::styled(letter.to_string(), span.style));
            }
        }
    }
    lines
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

/// A log line, cut to a given width.
pub(super) fn row(entry: &Entry, columns: usize) -> Parts {
    counted_row(entry, entry.count, columns)
}

/// The fewest columns of a text that is wrapped.
const LEAST_TEXT: usize = 16;

/// Log lines as rows, in their order. Rows that the lines do not need show the rest of sentences that one row would cut, those
/// of the first lines first.
pub(super) fn in_rows<'a>(
    entries: impl Iterator<Item = &'a Entry>,
    (columns, rows): (usize, usize),
) -> Vec<Parts> {
    let entries: Vec<&Entry> = entries.take(rows).collect();
    let mut spare = rows - entries.len();
    let mut shown = Vec::new();
    for entry in entries {
        let first = row(entry, columns);
        let indent: usize = first.iter().take(3).map(|(_, words)| text::width(words)).sum();
        let rest = text::wrap(&entry.text, columns.saturating_sub(indent + 1));
        let extra = rest.len().saturating_sub(1);
        if extra == 0 || extra > spare || columns < indent + LEAST_TEXT {
            shown.push(first);
            continue;
        }
        spare -= extra;
        let mut rest = rest.into_iter();
        let text = (Role::Text, rest.next().unwrap_or_default());
        shown.push(first.into_iter().take(3).chain([text]).collect());
        shown.extend(rest.map(|words| vec![(Role::Text, format!("{}{words}", " ".repeat(indent)))]));
    }
    shown
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
        (Role::Text, text::fit(&entry.text, room)),
        (Role::Dim, again),
    ]
}
