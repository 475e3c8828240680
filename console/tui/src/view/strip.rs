//! The control strip, for a terminal too small for a map: state, alarm, position, and the most important keys.

use super::look::{Look, Parts, ranked};
use super::next::Clauses;
use super::{confirm, coverage, footer, next, notice, position, text, top};
use crate::model::log::Entry;
use crate::model::{Model, Overlay};
use crate::theme::Role;
use mission::Severity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

/// The rank of the lines of events.
const EVENTS_RANK: u8 = 160;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let framed = area.width >= 24 && area.height >= 7;
    let title = format!("small terminal {}x{}", area.width, area.height);
    let block = look.block(Role::Border, &title, "");
    let inner = if framed { block.inner(area) } else { area };
    if framed {
        frame.render_widget(block, area);
    }
    let columns = usize::from(inner.width);
    // A question comes first, so that at this size nothing can push it off the screen. The other lines are ranked: the
    // last ones to be left out are the state, what comes next, the keys and the alarm.
    let is_asked = asks(look.model);
    let mut lines = Vec::new();
    // Of several lines with one rank, the first ones stay.
    let mut add = |rank: u8, more: Vec<Line<'static>>| {
        let ranks = (0..).map(|index| 16 * rank + u8::min(index, 15));
        lines.extend(ranks.zip(more));
    };
    let said = notice::lines(look.model, columns).into_iter();
    let said = said.flat_map(|(role, said)| said.into_iter().map(move |line| (role, format!(" {line}"))));
    if is_asked {
        add(0, wrapped(look, &confirm::clauses(look.model), columns));
    }
    add(1, vec![state(look, columns)]);
    add(3, alarm(look, columns));
    if !is_asked {
        add(1, wrapped(look, &without_alarm(look, next::clauses(look.model)), columns));
    }
    add(2, said.map(|part| look.line([part])).collect());
    add(4, vec![plain(look, &position(look), columns)]);
    add(5, tether(look).map(|tether| plain(look, &tether, columns)).into_iter().collect());
    add(6, way(look).map(|way| plain(look, &way, columns)).into_iter().collect());
    add(8, vec![plain(look, &ranging(look), columns)]);
    add(9, left(look).map(|left| plain(look, &left, columns)).into_iter().collect());
    add(2, vec![footer::line(look, columns)]);
    add(
        7,
        vec![Line::from(
            look.span(Role::Dim, text::fit(" Map requires 60x16. Controls work here.", columns)),
        )],
    );
    let rows = usize::from(inner.height).saturating_sub(lines.len());
    let events = events(look, (columns, rows)).into_iter().map(|line| (EVENTS_RANK, line));
    // The keys and the hint are below the events.
    let above = lines.len() - 2;
    lines.splice(above..above, events);
    frame.render_widget(Paragraph::new(ranked(lines, usize::from(inner.height))), inner);
}

fn plain(look: &Look, words: &str, columns: usize) -> Line<'static> {
    Line::from(look.span(Role::Text, text::fit(words, columns)))
}

/// The last fix and the stations.
fn ranging(look: &Look) -> String {
    format!(" fix {}", position::brief(look))
}

/// The remaining mission time.
fn left(look: &Look) -> Option<String> {
    look.run.is_running().then(|| format!(" time left {}", coverage::left(look, true)))
}

/// The newest events that fit without being cut, for the rows that are still free.
fn events(look: &Look, (columns, rows): (usize, usize)) -> Vec<Line<'static>> {
    let log = &look.run.log;
    let newest = (log.oldest()..log.end()).rev().filter_map(|number| log.get(number));
    let shown = newest.filter(|entry| entry.severity >= Severity::Info);
    let mut lines = Vec::new();
    for entry in shown {
        let event = event(look, entry, columns);
        if lines.len() + event.len() > rows {
            break;
        }
        lines.extend(event);
    }
    lines
}

/// The lines of an event: the first one begins with its time.
fn event(look: &Look, entry: &Entry, columns: usize) -> Vec<Line<'static>> {
    let role = super::events::role(entry.severity);
    let front = format!(" T+{} ", text::clock(entry.t_s));
    let indent = " ".repeat(text::width(&front));
    let room = columns.saturating_sub(text::width(&front));
    let clauses = text::clauses(&entry.text, room);
    // A single clause that does not fit takes several lines.
    let words = if clauses.ends_with('…') { text::wrap(&entry.text, room) } else { vec![clauses] };
    let fronts = std::iter::once(front).chain(std::iter::repeat(indent));
    fronts.zip(words).map(|(front, words)| look.line([(Role::Dim, front), (role, words)])).collect()
}

/// The tether: length out, reel, and largest wrap; a dash for a length that is not known yet.
fn tether(look: &Look) -> Option<String> {
    let reel = look.run.about.as_ref()?.mission.tether.as_ref()?.limits.reel_length_m;
    let Some(tether) = &look.run.tether else {
        return Some(format!(" tether - of {} m", text::number(reel, 1)));
    };
    let [out, reel] = [tether.length_m, reel].map(|length_m| text::number(length_m, 1));
    let wrap = tether.largest().map_or_else(String::new, |contact| {
        format!(", wrap {}° on {}", text::number(contact.wrap_rad.abs().to_degrees(), 0), contact.on)
    });
    let trouble = tether.trouble();
    let meter = text::meter(super::tether::out_share(look, tether));
    Some(format!(" {meter} tether {out} of {reel} m{wrap}{trouble}"))
}

/// The path driven, and the planner.
fn way(look: &Look) -> Option<String> {
    let done = text::percent(look.run.progress.as_ref()?.done);
    Some(format!(" path {done} % done, planner {}", look.run.planner_id().unwrap_or("-")))
}

/// The state and, if they fit, the counts of the alarms.
fn state(look: &Look, columns: usize) -> Line<'static> {
    let mut parts = plain_state(look);
    parts.extend(counts(look, columns).unwrap_or_default());
    look.line(parts)
}

fn plain_state(look: &Look) -> Parts {
    let mut parts = vec![(Role::Text, " ".to_owned())];
    parts.extend(top::state(look.model));
    parts.push((Role::Text, " ".into()));
    parts.extend(top::time(look.model));
    parts
}

/// The counts of the open alarms behind the state; `None` if they do not fit there.
fn counts(look: &Look, columns: usize) -> Option<Parts> {
    let width = |parts: &Parts| parts.iter().map(|(_, text)| text::width(text)).sum::<usize>();
    let room = columns.saturating_sub(width(&plain_state(look)));
    let forms = [top::Counts::Short, top::Counts::Worst]
        .map(|form| [vec![(Role::Text, "  ".to_owned())], top::alarms(look.model, form)].concat());
    forms.into_iter().find(|parts| width(parts) <= room)
}

/// The worst alarm in full, after the counts if these are not behind the state.
fn alarm(look: &Look, columns: usize) -> Vec<Line<'static>> {
    let Some(alarm) = look.run.alarms.worst() else { return Vec::new() };
    let mut counts = match counts(look, columns) {
        Some(_) => Vec::new(),
        None => [vec![(Role::Text, " ".to_owned())], top::alarms(look.model, top::Counts::Worst)].concat(),
    };
    let used: usize = counts.iter().map(|(_, text)| text::width(text)).sum();
    let cleared = if alarm.is_active() { "" } else { " (cleared)" };
    let said = format!("{}{cleared}", alarm.text);
    let mut words = text::wrap(&said, columns.saturating_sub(used + 1)).into_iter();
    let role = if counts.is_empty() { super::events::role(alarm.severity) } else { Role::Text };
    counts.push((role, format!(" {}", words.next().unwrap_or_default())));
    let indent = " ".repeat(used + 1);
    let more = words.map(|words| look.line([(role, format!("{indent}{words}"))]));
    std::iter::once(look.line(counts)).chain(more).collect()
}

fn position(look: &Look) -> String {
    let model = look.model;
    let bases = coverage::Bases::shown(look);
    let scanned = match bases.scanned()[0].as_str() {
        // The share is not known before the first step.
        "-" => String::new(),
        share => format!("{share} % of {}, ", bases.floors[0]),
    };
    let error =
        model.live.run.position.error_m().map_or_else(|| "-".into(), |error_m| text::number(error_m, 2));
    let lost = if model.live.run.position.lost { " LOST" } else { "" };
    format!(" {scanned}±{error} m{lost}")
}

/// The clauses without the one that only repeats the alarm above them.
fn without_alarm(look: &Look, (role, mut clauses): Clauses) -> Clauses {
    if let Some(alarm) = look.run.alarms.worst() {
        let repeated = format!("{}.", text::capitalized(&alarm.text));
        clauses.retain(|clause| *clause != repeated);
    }
    (role, clauses)
}

/// Clauses, wrapped into lines.
fn wrapped(look: &Look, (role, clauses): &Clauses, columns: usize) -> Vec<Line<'static>> {
    let lines = text::wrap(&clauses.join(" "), columns.saturating_sub(1));
    lines.into_iter().map(|line| Line::from(look.span(*role, format!(" {line}")))).collect()
}

/// Whether a question about moving or about quitting is open.
fn asks(model: &Model) -> bool {
    model.ui.overlay.is_question() || matches!(model.ui.overlay, Overlay::ZoneDraft(_))
}
