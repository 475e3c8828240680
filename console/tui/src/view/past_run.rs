//! The details of a past run: figures, holds, alarms, notes and a small map.

use super::fields::{self, Field};
use super::look::{Look, Parts};
use super::scroll::{self, Extent};
use super::small_map::{self, SmallMap};
use super::text;
use crate::guide;
use crate::model::ui::Arrangement;
use crate::model::{Glimpse, PastRun, Run, Together};
use crate::theme::Role;
use account::{Account, Summary};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use ratatui::widgets::Block;
use std::cmp::Reverse;
use std::collections::BTreeSet;

/// Width of the figure names, columns.
const NAMES: usize = 11;
/// The minimum width at which the map can be beside the figures, columns.
const BESIDE: u16 = 76;
/// Minimum and maximum width of the figures beside a map, columns.
const FIGURES: u16 = 46;
const MOST_FIGURES: u16 = 76;
/// The minimum number of rows below the figures at which the map is drawn there.
const BELOW: u16 = 9;
/// The number of missed areas that are marked on the map.
const MARKED: usize = 9;

/// When runs began, as a column of a list: to the second if two runs of a scenario began in the same minute.
#[derive(Clone, Copy)]
pub(super) struct Began {
    has_seconds: bool,
}

impl Began {
    pub(super) fn of(listed: &[&PastRun]) -> Self {
        let mut seen = BTreeSet::new();
        let has_seconds = listed
            .iter()
            .any(|run| run.began_unix_s.is_some() && !seen.insert((name(run), run.began.as_str())));
        Self { has_seconds }
    }

    /// The width of the column, with a blank behind it, columns.
    pub(super) fn width(self) -> usize {
        if self.has_seconds { 16 } else { 13 }
    }

    /// When a run began, in the width of the column.
    pub(super) fn text(self, run: &PastRun) -> String {
        let second = run.began_unix_s.filter(|_| self.has_seconds);
        let second = second.map_or_else(String::new, |s| format!(":{:02}", s.rem_euclid(60.0).floor()));
        let began = if run.began.is_empty() { "-" } else { &run.began };
        text::column(&format!("{began}{second}"), self.width())
    }
}

/// The details of a run, the area for them, and the area for the map.
struct Divided<'a> {
    lines: Vec<Line<'static>>,
    text: Rect,
    map: Option<(Rect, SmallMap<'a>)>,
}

fn divided<'a>(look: &Look<'a>, area: Rect, run: &PastRun) -> Divided<'a> {
    let inner = Block::bordered().inner(area);
    let glimpse = look.model.home.glimpses.of(&run.name).and_then(|found| found.as_ref().ok());
    let map = glimpse.and_then(|glimpse| map(glimpse));
    let beside = map.is_some() && is_beside(inner, |columns| lines(look, run, columns).len());
    let columns = map.as_ref().map_or(0, |map| map.columns(inner.height));
    let figures =
        if beside { inner.width.saturating_sub(columns).clamp(FIGURES, MOST_FIGURES) } else { inner.width };
    let lines = lines(look, run, usize::from(figures));
    let [left, right] = Layout::horizontal([Constraint::Length(figures), Constraint::Fill(1)]).areas(inner);
    let rows = (lines.len() as u16).min(left.height);
    let [text, below] = Layout::vertical([Constraint::Length(rows), Constraint::Fill(1)]).areas(left);
    let place = if beside { right } else { below };
    let map = map.filter(|_| beside || below.height >= BELOW).map(|map| (place, map));
    Divided { lines, text, map }
}

/// How much of the details of a run is visible in the area of their pane.
pub(super) fn extent(look: &Look, area: Rect, run: &PastRun) -> Extent {
    let divided = divided(look, area, run);
    Extent { shown: divided.text.height.into(), len: divided.lines.len() }
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, run: &PastRun) {
    let began = if run.began.is_empty() { String::new() } else { format!("  {} UTC", run.began) };
    let title = format!("{}{began}", name(run));
    let Divided { lines, text, map } = divided(look, area, run);
    let extent = Extent { shown: text.height.into(), len: lines.len() };
    frame.render_widget(scroll::block(look, (&title, ""), (area.width, extent)), area);
    scroll::lines(look, frame, text, lines);
    if let Some((area, map)) = map {
        small_map::draw(look, frame, area, &map);
    }
}

/// Whether the map is larger beside the figures than below them, given the lines of the figures for a width.
fn is_beside(area: Rect, lines: impl Fn(usize) -> usize) -> bool {
    // A cell is about twice as high as it is wide.
    let rows = |columns: u16, rows: u16| rows.min(columns / 2);
    let below = area.height.saturating_sub(lines(usize::from(area.width)) as u16);
    area.width >= BESIDE && rows(area.width - FIGURES, area.height) >= rows(area.width, below)
}

/// The name of the run's scenario, or of its folder if the scenario is unknown.
pub(super) fn name(run: &PastRun) -> &str {
    if run.scenario.is_empty() { &run.name } else { &run.scenario }
}

/// The lines about a run, most important first.
pub(super) fn lines(look: &Look, run: &PastRun, columns: usize) -> Vec<Line<'static>> {
    let found = look.model.home.glimpses.of(&run.name);
    let glimpse = found.and_then(|found| found.as_ref().ok());
    let summary = glimpse.and_then(|glimpse| glimpse.summary.as_deref());
    let room = columns.saturating_sub(NAMES + 3);
    let mut lines = fields::lines(look, &outcome(run, summary, room), NAMES, columns);
    lines.extend(notes(look, run, columns).into_iter().map(|parts| look.line(parts)));
    if let Some(glimpse) = glimpse {
        let figures = summary.map(|summary| figures(summary, glimpse.together())).unwrap_or_default();
        let combined = combined(glimpse).into_iter();
        let all: Vec<Field> = combined.chain(figures).chain(events(&glimpse.run, summary)).collect();
        lines.extend(fields::lines(look, &all, NAMES, columns));
    } else if let Some(Err(why)) = found {
        lines.extend(wrapped(Role::Warn, why, columns).map(|parts| look.line(parts)));
    } else if look.model.ui.arrangement() == Arrangement::Wide {
        let moves = look.model.live.may_move();
        let words =
            if moves { "Details are read once the robot stands still." } else { "Reading the run..." };
        lines.extend(wrapped(Role::Dim, words, columns).map(|parts| look.line(parts)));
    }
    lines
}

fn outcome(run: &PastRun, summary: Option<&Summary>, room: usize) -> Vec<Field> {
    let took = run.mission_time_s.map_or_else(String::new, |s| format!(" after {}", text::clock(s)));
    let reason = summary.and_then(|summary| summary.reason.as_ref());
    let reason = reason.map_or_else(String::new, |reason| format!(": {reason}"));
    let verified = run.verified.as_ref().map(|at| ("verified", format!("{at} UTC, equal")));
    let mut fields = vec![("end", format!("{}{took}{reason}", run.end))];
    fields.extend(
        run.reachable.map(|share| ("scanned", format!("{} % of reachable floor", text::percent(share)))),
    );
    fields.extend((!run.planner.is_empty()).then(|| ("planner", run.planner.clone())));
    fields.push(("folder", broken(&run.name, room)));
    fields.extend(verified);
    fields
}

/// A name with blanks where it has to be broken to fit into lines; it is broken after hyphens if possible.
fn broken(name: &str, room: usize) -> String {
    let (mut lines, mut rest) = (Vec::new(), name);
    while text::width(rest) >= room.max(8) {
        let fitting = text::fit(rest, room.max(8) - 1);
        let most = fitting.trim_end_matches('…').len();
        let at = rest[..most].rfind('-').map_or(most, |hyphen| hyphen + 1);
        let (line, after) = rest.split_at(at);
        lines.push(line);
        rest = after;
    }
    lines.push(rest);
    lines.join(" ")
}

/// The problem, the remark and the bookmarks of a run.
fn notes(look: &Look, run: &PastRun, columns: usize) -> Vec<Parts> {
    let mut lines: Vec<Parts> = Vec::new();
    if let Some(note) = &run.note {
        lines.extend(wrapped(Role::Warn, &format!("* {note}"), columns));
    }
    if let Some(remark) = &run.remark {
        lines.extend(wrapped(Role::Title, &format!("Remark: {remark}"), columns));
    }
    let replay = look.model.live.replay.as_ref().filter(|replay| replay.name == run.name);
    for bookmark in replay.iter().flat_map(|replay| &replay.notes.bookmarks) {
        let words = format!("● T+{} {}", text::clock(bookmark.t_s), bookmark.text);
        lines.extend(wrapped(Role::Text, &words, columns));
    }
    if replay.is_none() && run.bookmarks > 0 {
        let plural = if run.bookmarks == 1 { "" } else { "s" };
        lines.extend(wrapped(Role::Dim, &format!("● {} bookmark{plural}", run.bookmarks), columns));
    }
    lines
}

/// What a re-scan and the runs before it have scanned together.
fn combined(glimpse: &Glimpse) -> Option<Field> {
    let words = match glimpse.combined.as_ref()? {
        Ok(all) => {
            let (reachable, whole) = (&all.floor.reachable.percent, &all.floor.whole.percent);
            format!(
                "with {}: {} % of reachable floor, {} % of the whole",
                all.before(),
                text::number(reachable.scanned, 1),
                text::number(whole.scanned, 1)
            )
        }
        Err(why) => format!("this run alone; the runs cannot be combined: {why}"),
    };
    Some(("all runs", words))
}

fn figures(summary: &Summary, together: Option<&Together>) -> Vec<Field> {
    let metres = |m: f64, decimals| format!("{} m", text::number(m, decimals));
    let mut fields: Vec<Field> = Vec::new();
    fields.extend(summary.path_length_m.map(|m| ("path", metres(m, 1))));
    fields.extend(summary.clearance_min_m.map(|m| ("clearance", format!("minimum {} (true)", metres(m, 2)))));
    if let Some(accuracy) = &summary.accuracy {
        let (p95, most, limit) =
            (metres(accuracy.p95_m, 2), metres(accuracy.max_m, 2), metres(accuracy.limit_m, 2));
        let what = if summary.floor.is_some() { "scan limit" } else { "limit" };
        fields.push(("95 % error", format!("p95 {p95}, worst {most}, {what} {limit}")));
    }
    if let Some(tether) = &summary.tether {
        let wrap = text::number(tether.wrap_max_rad.to_degrees(), 0);
        fields.push(("tether", format!("{} out, wrap {wrap}°", metres(tether.tether_length_max_m, 1))));
    }
    if let Some(floor) = together.map(|all| &all.floor).or(summary.floor.as_ref()) {
        let missed = floor.listed();
        let area_m2: f64 = missed.iter().map(|area| area.area_m2).sum();
        let small = super::missed::small(floor);
        fields.push((
            "missed",
            format!("{}, {} m²{small}", text::counted(missed.len(), "area"), text::number(area_m2, 2)),
        ));
    }
    for violation in summary.violations.iter().flatten() {
        fields.push(("not met", violation.clone()));
    }
    fields
}

/// What happened during the run.
fn events(run: &Run, summary: Option<&Summary>) -> Vec<Field> {
    let mut fields: Vec<Field> = Vec::new();
    if let Some(summary) = summary {
        let (holds, faults) = (summary.holds, summary.planner_faults);
        let collisions = summary.collisions.map_or_else(|| "not known".to_owned(), |n| n.to_string());
        fields.push(("holds", format!("{holds}, collisions {collisions}, planner faults {faults}")));
        fields.extend(
            (summary.obstacles_found > 0)
                .then(|| ("found", text::counted(summary.obstacles_found as usize, "obstacle"))),
        );
    }
    let mut alarms: Vec<_> = run.alarms.list().iter().collect();
    alarms.sort_by_key(|alarm| Reverse(alarm.severity));
    let words = alarms.iter().map(|alarm| {
        let times = if alarm.count > 1 { format!(" {}×", alarm.count) } else { String::new() };
        format!("{}{times}", guide::name(&alarm.cause, run))
    });
    let words: Vec<String> = words.collect();
    fields.push(("alarms", if words.is_empty() { "none".into() } else { words.join(", ") }));
    fields
}

/// The map of a run with its largest missed areas.
fn map(glimpse: &Glimpse) -> Option<SmallMap<'_>> {
    let together = glimpse.together();
    let mut map = SmallMap::of_run(&glimpse.run, together)?;
    let own = || glimpse.summary.as_ref().and_then(|summary| summary.floor.as_ref());
    let floor = together.map(|all| &all.floor).or_else(own);
    let listed = floor.map(Account::listed).unwrap_or_default();
    for (index, area) in listed.into_iter().take(MARKED).enumerate() {
        map = map.marked(area.at, super::missed::role(area), &(index + 1).to_string());
    }
    Some(map)
}

fn wrapped(role: Role, words: &str, columns: usize) -> impl Iterator<Item = Parts> + use<> {
    let lines = text::wrap(words, columns.saturating_sub(2)).into_iter();
    lines.map(move |line| vec![(role, format!(" {}", text::fit(&line, columns.saturating_sub(2))))])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_one_minute_are_told_apart_by_their_seconds() {
        let run = |scenario: &str, began: &str, second: f64| PastRun {
            scenario: scenario.into(),
            began: began.into(),
            began_unix_s: Some(1_795_000_020.0 + second),
            ..past("20261130T013224Z-demo")
        };
        let [one, other] = [run("demo", "30 Nov 01:32", 24.0), run("demo", "30 Nov 01:32", 45.9)];
        let began = Began::of(&[&one, &other]);
        assert_eq!([began.text(&one), began.text(&other)], ["30 Nov 01:32:24 ", "30 Nov 01:32:45 "]);
        let apart = [run("demo", "30 Nov 01:33", 24.0), run("cart", "30 Nov 01:32", 24.0)];
        for other in &apart {
            assert_eq!(Began::of(&[&one, other]).text(&one), "30 Nov 01:32 ");
        }
    }

    fn past(name: &str) -> PastRun {
        PastRun {
            name: name.into(),
            began: String::new(),
            began_unix_s: None,
            scenario: String::new(),
            planner: String::new(),
            end: "complete".into(),
            mission_time_s: None,
            reachable: None,
            verified: None,
            note: None,
            remark: None,
            bookmarks: 0,
        }
    }

    #[test]
    fn a_long_name_is_broken_after_hyphens_and_loses_nothing() {
        let name = "20261122T040049Z-cover-unknown-columns-tether-safe-42";
        let lines = broken(name, 26);
        assert_eq!(lines, "20261122T040049Z-cover- unknown-columns-tether- safe-42");
        assert_eq!((lines.replace(' ', ""), broken("short", 26)), (name.to_owned(), "short".to_owned()));
        assert_eq!(broken(&"漢".repeat(20), 10).replace(' ', ""), "漢".repeat(20));
    }
}
