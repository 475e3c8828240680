//! Describes the selected line of the home screen, beside the lists of a wide screen.

use super::{attention, runs, scenarios, setup};
use crate::model::home::HomeList;
use crate::model::{PastRun, ScenarioEntry};
use crate::theme::Role;
use crate::view::fields::{self, Field};
use crate::view::look::{Look, Parts, fill};
use crate::view::small_map::{self, SmallMap};
use crate::view::{past_run, run_details, text};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use std::collections::BTreeSet;

/// Width of the figure names, columns.
const NAMES: usize = 10;
/// Minimum width at which past runs are listed with their durations, columns.
const TIMED: usize = 50;
/// The number of past runs listed about a scenario.
const RUNS: usize = 6;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let home = &look.model.home;
    let nothing = || vec![look.line([(Role::Dim, " Nothing is selected.".into())])];
    match home.list {
        HomeList::Scenarios => match home.selected_scenario() {
            Some(entry) => scenario(look, frame, area, entry),
            None => fill(frame, area, look.block(Role::Border, "Scenario", ""), nothing()),
        },
        HomeList::Runs => match home.selected_run() {
            Some(selected) => run(look, frame, area, selected),
            None => fill(frame, area, look.block(Role::Border, "Run", ""), nothing()),
        },
        HomeList::Attention => {
            let columns = usize::from(area.width).saturating_sub(2);
            let (title, lines) = match home.selected_attention() {
                Some(point) => {
                    let lines = attention::whole(point, columns).into_iter().map(|parts| look.line(parts));
                    (point.kind.clone(), lines.collect())
                }
                None => ("Attention".to_owned(), nothing()),
            };
            fill(frame, area, look.block(Role::Border, &title, ""), lines);
        }
    }
}

/// A scenario; on a large screen, with its settings and its last run.
fn scenario(look: &Look, frame: &mut Frame, area: Rect, entry: &ScenarioEntry) {
    let is_large = look.model.ui.is_large();
    let is_read = |run: &&PastRun| look.model.home.glimpses.of(&run.name).is_some_and(Result::is_ok);
    let last = look.model.home.last_end(&entry.name).filter(|_| is_large).filter(is_read);
    let lines_in = |columns: u16| lines(look, entry, usize::from(columns));
    let Some(last) = last else {
        let block = look.block(Role::Border, &entry.name, "");
        let inner = block.inner(area);
        frame.render_widget(block, area);
        let lines = lines_in(inner.width);
        let rows = (lines.len() as u16).min(inner.height);
        let [text, below] = Layout::vertical([Constraint::Length(rows), Constraint::Fill(1)]).areas(inner);
        fill(frame, text, ratatui::widgets::Block::new(), lines);
        if let Some(world) = &entry.world {
            small_map::draw(look, frame, below, &SmallMap::of(world));
        }
        return;
    };
    let lines = lines_in(area.width.saturating_sub(2));
    let rows = lines.len() as u16 + 2;
    let [above, below] = Layout::vertical([Constraint::Length(rows), Constraint::Fill(1)]).areas(area);
    fill(frame, above, look.block(Role::Border, &entry.name, ""), lines);
    run(look, frame, below, last);
}

/// A past run; on a large screen, with its missed areas and curves.
fn run(look: &Look, frame: &mut Frame, area: Rect, run: &PastRun) {
    let glimpse = look.model.home.glimpses.of(&run.name).and_then(|found| found.as_ref().ok());
    let Some(glimpse) = glimpse.filter(|_| look.model.ui.is_large()) else {
        return past_run::draw(look, frame, area, run);
    };
    let [figures, details] = Layout::vertical([Constraint::Fill(3), Constraint::Fill(2)]).areas(area);
    past_run::draw(look, frame, figures, run);
    run_details::draw(look, frame, details, glimpse, false);
}

fn lines(look: &Look, entry: &ScenarioEntry, columns: usize) -> Vec<Line<'static>> {
    let wrapped = |role, words: &str| {
        let lines = text::wrap(words, columns.saturating_sub(2)).into_iter();
        lines.map(move |line| vec![(role, format!(" {line}"))]).collect::<Vec<Parts>>()
    };
    if let Some(problem) = &entry.problem {
        let lines = problem.lines().flat_map(|line| wrapped(Role::Warn, line));
        return lines.map(|parts| look.line(parts)).collect();
    }
    let mut lines: Vec<Line> = wrapped(Role::Text, &scenarios::description(entry))
        .into_iter()
        .map(|parts| look.line(parts))
        .collect();
    let mut fields: Vec<Field> =
        vec![("task", format!("{}, {}", entry.task, entry.tank)), ("planner", entry.planner.clone())];
    if let Some(world) = &entry.world {
        let stations = text::counted(world.stations.len(), "station");
        let obstacles = text::counted(world.obstacles.len(), "obstacle");
        fields.push(("drawing", format!("{stations}, {obstacles}")));
    }
    if let Some(mission) = entry.mission.as_ref().filter(|_| look.model.ui.is_large()) {
        fields.extend(setup::fields(mission));
    }
    lines.extend(fields::lines(look, &fields, NAMES, columns));
    lines.push(Line::default());
    lines.extend(last_runs(look, entry, columns).into_iter().map(|parts| look.line(parts)));
    lines
}

/// The last runs of a scenario, newest first.
fn last_runs(look: &Look, entry: &ScenarioEntry, columns: usize) -> Vec<Parts> {
    let runs = look.model.home.found.iter().flat_map(|found| &found.runs);
    let runs: Vec<_> = runs.filter(|run| run.scenario == entry.name).collect();
    if runs.is_empty() {
        return vec![vec![(Role::Dim, " No run of this scenario yet.".into())]];
    }
    let row = |run: &&PastRun| -> Parts {
        let reach = run.reachable.map_or_else(String::new, |share| format!("{} %", text::percent(share)));
        let took = run.mission_time_s.map_or_else(String::new, text::clock);
        vec![
            (Role::Dim, format!(" {}", text::column(&run.began, 13))),
            (runs::role(run), text::column(runs::end_word(run), 11)),
            (Role::Dim, if columns >= TIMED { format!("{took:>9}") } else { String::new() }),
            (Role::Text, format!("{reach:>8}")),
            (Role::Good, runs::verified(run).to_owned()),
        ]
    };
    let mut rows: Vec<Parts> = runs.iter().take(RUNS).map(row).collect();
    if let Some(more) = runs.len().checked_sub(RUNS).filter(|more| *more > 0) {
        rows.push(vec![(Role::Dim, format!(" {more} earlier runs"))]);
    }
    rows
}

/// The number of plugins and planners, and the plugins that were refused.
pub(super) fn plugins(look: &Look, frame: &mut Frame, area: Rect) {
    let console = &look.model.console;
    let block = look.block(Role::Border, "Plugins", &look.keys("<plugins> details"));
    let columns = usize::from(block.inner(area).width);
    let plugins: BTreeSet<&str> = console.planners.iter().map(|info| info.plugin.as_str()).collect();
    let found = format!(" planners {}, plugins {}", console.planners.len(), plugins.len());
    let mut lines = vec![look.line([(Role::Text, found)])];
    lines.extend(console.refused.iter().take(2).map(|refused| {
        let words = format!(" REFUSED {}: {}", refused.plugin, refused.reason);
        look.line([(Role::Watch, text::clauses(&words, columns))])
    }));
    fill(frame, area, block, lines);
}
