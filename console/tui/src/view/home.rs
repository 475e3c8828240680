//! The home screen: scenarios, past runs and problems.

use super::look::{Look, Parts, fill};
use super::{events, table, text};
use crate::model::home::{Attention, Found, HomeList};
use crate::model::ui::Arrangement;
use crate::model::{PastRun, ScenarioEntry};
use crate::theme::Role;
use crate::update::Rows;
use mission::Severity;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;

/// Maximum rows of the attention pane, including the frame.
const ATTENTION: u16 = 10;
/// Width of a scenario's task, and the minimum width for how its last run ended, columns.
const TASK: usize = 7;
const END: usize = 10;

pub(crate) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let Some(found) = &look.model.home.found else {
        let block = look.block(Role::Border, "Home", "");
        return fill(
            frame,
            area,
            block,
            vec![look.line([(Role::Dim, " Looking for scenarios and runs...".into())])],
        );
    };
    if arrangement == Arrangement::Paged {
        return match look.model.home.list {
            HomeList::Scenarios => scenarios(look, frame, area),
            HomeList::Runs => runs(look, frame, area),
        };
    }
    let wide = arrangement == Arrangement::Wide;
    let rows = attention_rows(found).len() as u16 + 2;
    let [lists, attention] = Layout::vertical([
        Constraint::Fill(1),
        Constraint::Length(rows.min(if wide { ATTENTION } else { 6 })),
    ])
    .areas(area);
    let share = if wide { Constraint::Length(62) } else { Constraint::Percentage(53) };
    let [left, right] = Layout::horizontal([share, Constraint::Fill(1)]).areas(lists);
    scenarios(look, frame, left);
    if wide {
        let rows = 5;
        let [past, plugins_area] =
            Layout::vertical([Constraint::Fill(1), Constraint::Length(rows)]).areas(right);
        runs(look, frame, past);
        plugins(look, frame, plugins_area);
    } else {
        runs(look, frame, right);
    }
    let block = look.block(Role::Border, &format!("Attention  {}", open_points(found)), &disk(found));
    let height = usize::from(block.inner(attention).height);
    let mut rows = attention_rows(found);
    if rows.len() > height {
        let more = rows.len() - height.saturating_sub(1);
        rows.truncate(height.saturating_sub(1));
        rows.push(vec![(Role::Watch, format!(" {more} more items; `tankops runs` lists every run"))]);
    }
    fill(frame, attention, block, rows.into_iter().map(|parts| look.line(parts)).collect());
}

fn border(look: &Look, list: HomeList) -> Role {
    if look.model.home.list == list { Role::Focus } else { Role::Border }
}

fn scenarios(look: &Look, frame: &mut Frame, area: Rect) {
    let home = &look.model.home;
    let listed = home.scenarios();
    let note = filter_note(look);
    let inner = look.block(Role::Border, "", "").inner(area);
    let (columns, height) = (usize::from(inner.width), usize::from(inner.height));
    let names = name_columns(&listed, columns);
    let rows: Vec<Parts> = listed.iter().map(|entry| scenario_row(look, entry, names, columns)).collect();
    let selected = (home.list == HomeList::Scenarios).then_some(home.scenario);
    // Sized for the longest text, so that the height does not depend on the selection.
    let longest = listed.iter().map(|entry| about_lines(look, entry, columns).len()).max().unwrap_or(0);
    let about = if height > 12 { longest.min(height / 2) } else { 0 };
    let shown = table::window(selected.unwrap_or(0), rows.len(), height - about);
    let title = format!("Scenarios  {}", table::counted(&shown, rows.len()));
    let block = look.block(border(look, HomeList::Scenarios), &title, &note);
    table::place(look, inner, Rows::Scenarios, shown);
    let mut lines = table::rows(look, rows, selected, (columns, height - about));
    if lines.is_empty() {
        let words = if home.filter.is_empty() {
            " No scenarios here; `tankops console FILE` opens one.".to_owned()
        } else {
            format!(" No scenario matches `{}`.", text::fit(&home.filter, columns.saturating_sub(26)))
        };
        lines.push(look.line([(Role::Dim, words)]));
    }
    lines.resize(height - about, Line::default());
    lines.extend(
        listed.get(home.scenario).into_iter().flat_map(|entry| about_lines(look, entry, columns)).take(about),
    );
    fill(frame, area, block, lines);
}

fn name_columns(listed: &[&ScenarioEntry], columns: usize) -> usize {
    let widest = listed.iter().map(|entry| text::width(&entry.name)).max().unwrap_or(0);
    (widest + 1).min(columns.saturating_sub(TASK + END + 1))
}

fn scenario_row(look: &Look, entry: &ScenarioEntry, names: usize, columns: usize) -> Parts {
    let name = (Role::Text, text::column(&entry.name, names));
    let rest = columns.saturating_sub(names + 1);
    if entry.problem.is_some() {
        return vec![name, (Role::Warn, text::fit("INVALID", rest))];
    }
    let mut parts = vec![name, (Role::Dim, text::column(&entry.task, TASK))];
    if rest >= 34 {
        parts.push((Role::Dim, text::column(&entry.tank, 9)));
        parts.push((Role::Dim, text::column(&entry.planner, 12)));
    }
    let last = look.model.home.last_end(&entry.name).map_or_else(|| "-".into(), end);
    let used: usize = parts.iter().map(|(_, text)| text::width(text)).sum();
    parts.push((Role::Text, text::fit(&last, columns.saturating_sub(used + 1))));
    parts
}

/// How a run ended, with its coverage if the run's task was to scan.
fn end(run: &PastRun) -> String {
    match run.reachable {
        Some(share) if run.end == "complete" => format!("{} %", text::percent(share)),
        _ => end_word(run).to_owned(),
    }
}

/// How a run ended, in at most ten columns.
fn end_word(run: &PastRun) -> &str {
    match run.end.as_str() {
        "RECORDING FAILED" => "REC FAILED",
        "time_limit" => "time limit",
        other => other,
    }
}

fn about_lines(look: &Look, entry: &ScenarioEntry, columns: usize) -> Vec<Line<'static>> {
    let words = match (&entry.problem, entry.expected.is_empty()) {
        (Some(problem), _) => problem.clone(),
        (None, true) => format!("{}.", entry.about),
        (None, false) => format!("{}. Expected: {}.", entry.about, entry.expected),
    };
    let role = if entry.problem.is_some() { Role::Warn } else { Role::Dim };
    let wrapped = text::wrap(&words, columns.saturating_sub(2));
    wrapped.into_iter().map(|line| look.line([(role, format!(" {line}"))])).collect()
}

fn runs(look: &Look, frame: &mut Frame, area: Rect) {
    let home = &look.model.home;
    let listed = home.runs();
    let logs = home.found.as_ref().map_or("", |found| found.logs.as_str());
    let inner = look.block(Role::Border, "", "").inner(area);
    let (columns, height) = (usize::from(inner.width), usize::from(inner.height));
    let names = listed.iter().map(|run| text::width(name_of(run)) + 1).max().unwrap_or(0);
    let widths = run_columns(names, columns);
    let rows: Vec<Parts> = listed.iter().map(|run| run_row(run, widths)).collect();
    let selected = (home.list == HomeList::Runs).then_some(home.run);
    let shown = table::window(selected.unwrap_or(0), rows.len(), height);
    let title = format!("Past runs  {}", table::counted(&shown, rows.len()));
    let block = look.block(border(look, HomeList::Runs), &title, logs);
    table::place(look, inner, Rows::Runs, shown);
    let mut lines = table::rows(look, rows, selected, (columns, height));
    if lines.is_empty() {
        let words = if home.filter.is_empty() { " No runs yet." } else { " No run matches." };
        lines.push(look.line([(Role::Dim, words.into())]));
    }
    fill(frame, area, block, lines);
}

/// Width of a run's start, duration and coverage, each with a blank, columns.
const BEGAN: usize = 12;
const TIME: usize = 9;
const REACH: usize = 7;

/// The column widths in the list of runs. To make the names fit, the time is dropped first, then everything except
/// the outcome.
fn run_columns(names: usize, columns: usize) -> [usize; 4] {
    let least = 1 + names + END + 1;
    let room = |rest: usize| columns.saturating_sub(1 + END + 1 + rest);
    if columns >= least + BEGAN + TIME + REACH {
        [BEGAN, room(BEGAN + TIME + REACH), TIME, REACH]
    } else if columns >= least + BEGAN + REACH {
        [BEGAN, room(BEGAN + REACH), 0, REACH]
    } else {
        [0, room(0), 0, 0]
    }
}

fn name_of(run: &PastRun) -> &str {
    if run.scenario.is_empty() { &run.name } else { &run.scenario }
}

fn run_row(run: &PastRun, [began, name, time, reach]: [usize; 4]) -> Parts {
    let took = run.mission_time_s.map_or_else(|| "-".into(), text::clock);
    let scanned = run.reachable.map_or_else(String::new, |share| format!("{} %", text::percent(share)));
    // If there is no column for the coverage, the coverage is more useful here than the word "complete".
    let end = if reach == 0 && run.end == "complete" && run.reachable.is_some() {
        scanned.clone()
    } else {
        end_word(run).to_owned()
    };
    let is_sound = matches!(run.end.as_str(), "complete" | "aborted");
    let parts = [
        (Role::Dim, text::column(&run.began, began)),
        (Role::Text, text::column(name_of(run), name)),
        (if is_sound { Role::Text } else { Role::Warn }, text::column(&end, END + 1)),
        (Role::Dim, text::column(&took, time)),
        (Role::Text, if reach > 0 { format!("{scanned:>reach$}") } else { String::new() }),
    ];
    parts.into()
}

fn plugins(look: &Look, frame: &mut Frame, area: Rect) {
    let console = &look.model.console;
    let block = look.block(Role::Border, "Plugins", "");
    let columns = usize::from(block.inner(area).width);
    let plugins: std::collections::BTreeSet<&str> =
        console.planners.iter().map(|info| info.plugin.as_str()).collect();
    let found = format!(" planners {}, plugins {}", console.planners.len(), plugins.len());
    let mut lines = vec![look.line([(Role::Text, found)])];
    lines.extend(console.refused.iter().take(2).map(|refused| {
        let words = format!(" REFUSED {}: {}", refused.plugin, refused.reason);
        look.line([(Role::Watch, text::clauses(&words, columns))])
    }));
    fill(frame, area, block, lines);
}

fn filter_note(look: &Look) -> String {
    match look.model.home.filter.as_str() {
        "" => look.keys("<filter> filter  <next-pane> list"),
        filter => format!("`{}`", text::fit(filter, 20)),
    }
}

/// The number of items that require the operator's attention.
fn open_points(found: &Found) -> usize {
    found.attention.iter().filter(|point| point.severity > Severity::Info).count()
}

fn disk(found: &Found) -> String {
    found.free_bytes.map_or_else(String::new, |bytes| format!("disk {} GB free", bytes / 1_000_000_000))
}

fn attention_rows(found: &Found) -> Vec<Parts> {
    found.attention.iter().map(attention_row).collect()
}

fn attention_row(point: &Attention) -> Parts {
    let role = if point.severity == Severity::Info { Role::Good } else { events::role(point.severity) };
    vec![(role, format!(" {}", text::column(&point.kind, 11))), (Role::Text, point.text.clone())]
}
