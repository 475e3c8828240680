//! The list of scenarios.

use super::pane::{Pane, sentence};
use super::{border, note, runs};
use crate::model::home::HomeList;
use crate::model::{PastRun, ScenarioEntry};
use crate::theme::Role;
use crate::update::{Rows, go};
use crate::view::look::{Look, Parts};
use crate::view::text;
use mission::Phase;
use ratatui::Frame;
use ratatui::layout::Rect;

/// The column widths; a column that does not fit is 0 wide.
#[derive(Clone, Copy)]
struct Columns {
    name: usize,
    task: usize,
    tank: usize,
    planner: usize,
    end: usize,
    reach: usize,
    age: usize,
}

/// Maximum width of a tank and of a planner, columns.
const TANK: usize = 10;
const PLANNER: usize = 17;

/// The columns that fit beside the names. If space is short, the tank is dropped first, then the planner.
fn columns(listed: &[&ScenarioEntry], room: usize) -> Columns {
    let widest_of = |name: fn(&ScenarioEntry) -> &str| {
        listed.iter().map(|entry| text::width(name(entry))).max().unwrap_or(0).max(8) + 1
    };
    let widest = widest_of(|entry| &entry.name);
    let (tank, planner) = (widest_of(|entry| &entry.tank), widest_of(|entry| &entry.planner));
    let (tank, planner) = (tank.min(TANK), planner.min(PLANNER));
    let full = Columns { name: 0, task: 7, tank, planner, end: 12, reach: 8, age: 7 };
    let of = |columns: Columns| {
        let Columns { task, tank, planner, end, reach, age, .. } = columns;
        let name = room.saturating_sub(1 + task + tank + planner + end + reach + age);
        Columns { name, ..columns }
    };
    let short = Columns { tank: 0, ..full };
    let least = Columns { planner: 0, ..short };
    let all = [of(full), of(short), of(least)];
    let fitting = all.into_iter().find(|columns| columns.name >= widest.min(22)).unwrap_or(all[2]);
    // The remaining width goes to the column `end`, whose texts benefit most from it.
    Columns {
        end: fitting.end + fitting.name.saturating_sub(widest),
        name: fitting.name.min(widest),
        ..fitting
    }
}

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, about: bool) {
    let home = &look.model.home;
    let listed = home.scenarios();
    let room = usize::from(area.width).saturating_sub(2);
    let at = columns(&listed, room);
    let empty = if home.filter.is_empty() {
        " No scenarios here; `tankops console FILE` opens one.".to_owned()
    } else {
        format!(" No scenario matches `{}`.", text::fit(&home.filter, room.saturating_sub(26)))
    };
    let selected = home.selected_scenario().filter(|_| about);
    let pane = Pane {
        border: border(look, HomeList::Scenarios),
        title: "Scenarios",
        note: note(look, HomeList::Scenarios),
        heads: Some(heads(at)),
        rows: listed.iter().map(|entry| row(look, entry, at, room)).collect(),
        selected: (home.list == HomeList::Scenarios).then_some(home.scenario),
        list: Rows::Scenarios,
        empty,
        about: selected.map(|entry| (entry.name.clone(), about_lines(entry, room))),
    };
    pane.draw(look, frame, area);
}

fn heads(at: Columns) -> String {
    let head = |word: &str, width: usize| if width > 0 { text::column(word, width) } else { String::new() };
    let right = |word: &str, width: usize| format!("{word:>width$}");
    [
        format!(" {}", text::column("name", at.name)),
        head("task", at.task),
        head("tank", at.tank),
        head("planner", at.planner),
        head("last end", at.end),
        right("reach", at.reach),
        right("age", at.age),
    ]
    .concat()
}

fn row(look: &Look, entry: &ScenarioEntry, at: Columns, room: usize) -> Parts {
    let name = (Role::Text, text::column(&entry.name, at.name));
    if let Some(why) = entry.briefly() {
        let left = room.saturating_sub(at.name + 1);
        return vec![name, (Role::Warn, text::clauses(&format!("INVALID  {why}"), left))];
    }
    let last = look.model.home.last_end(&entry.name);
    // The figures of the last run would look like those of the open mission.
    let figures = last.filter(|_| !go::is_open_mission(look.model, entry));
    let reach = figures
        .and_then(|run| run.reachable)
        .map_or_else(|| "-".into(), |s| format!("{} %", text::percent(s)));
    let (role, end) = end(look, entry, last);
    vec![
        name,
        (Role::Dim, text::column(&entry.task, at.task)),
        (Role::Dim, text::column(&entry.tank, at.tank)),
        (Role::Dim, text::column(&text::fit(&entry.planner, at.planner.saturating_sub(1)), at.planner)),
        (role, text::column(&end, at.end)),
        (Role::Text, format!("{reach:>width$}", width = at.reach)),
        (Role::Dim, format!("{:>width$}", age(look, figures), width = at.age)),
    ]
}

/// The state of the open mission, or how the last run of the scenario ended.
fn end(look: &Look, entry: &ScenarioEntry, last: Option<&PastRun>) -> (Role, String) {
    let live = &look.model.live;
    if go::is_open_mission(look.model, entry) {
        let state = match live.run.phase() {
            _ if live.is_opening => "opening",
            Phase::Waiting if live.busy.is_some() => "planning",
            Phase::Waiting => "ready",
            Phase::Running(_) => "RUN",
            Phase::Held(_) => "HELD",
            Phase::Ended(_) => "ended",
        };
        return (Role::Title, format!("open, {state}"));
    }
    last.map_or((Role::Dim, "-".into()), |run| (runs::role(run), runs::end_word(run).to_owned()))
}

/// How long ago a run began.
fn age(look: &Look, run: Option<&PastRun>) -> String {
    let now_s = look.model.console.now.wall_unix_s;
    let began_s = run.and_then(|run| run.began_unix_s);
    began_s.map_or_else(|| "-".into(), |began_s| text::ago(now_s - began_s))
}

/// The description of a scenario, or all that is wrong with it.
pub(super) fn about_lines(entry: &ScenarioEntry, columns: usize) -> Vec<Parts> {
    match &entry.problem {
        Some(problem) => problem_lines(problem, columns),
        None => sentence(Role::Dim, &description(entry), columns),
    }
}

/// All errors of a scenario, then the advice, which may be long.
fn problem_lines(problem: &str, columns: usize) -> Vec<Parts> {
    let mut lines: Vec<&str> = problem.lines().filter(|line| !is_extract(line)).collect();
    lines.sort_by_key(|line| !line.starts_with("error"));
    let lines = lines.into_iter().flat_map(|line| text::wrap(line, columns.saturating_sub(2)));
    lines.map(|line| vec![(Role::Warn, format!(" {line}"))]).collect()
}

/// Whether a line of an error is an extract of the file, which a narrow pane has no room for.
fn is_extract(line: &str) -> bool {
    line.trim_start_matches([' ', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9']).starts_with('|')
}

/// The description of a scenario, and its expected outcome.
pub(super) fn description(entry: &ScenarioEntry) -> String {
    match (entry.about.is_empty(), entry.expected.is_empty()) {
        (true, true) => "No description.".into(),
        (false, true) => format!("{}.", entry.about),
        (true, false) => format!("Expected: {}.", entry.expected),
        (false, false) => format!("{}. Expected: {}.", entry.about, entry.expected),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_error_of_a_scenario_comes_before_the_advice_and_without_extracts() {
        let problem = "error: tank.toml:8:1: robot.speeed = 3: unknown key\n   |\n 8 | speeed = 3\n   | ^^^^^^\n\
                       help: the keys of [robot] are radius_m\nerror: tank.toml:9:1: tank.x: missing\n9 | [tank]";
        let lines = problem_lines(problem, 80).into_iter().flatten().map(|(_, words)| words);
        assert_eq!(
            lines.collect::<Vec<_>>(),
            [
                " error: tank.toml:8:1: robot.speeed = 3: unknown key",
                " error: tank.toml:9:1: tank.x: missing",
                " help: the keys of [robot] are radius_m",
            ]
        );
    }
}
