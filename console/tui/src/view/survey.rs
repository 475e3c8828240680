//! The survey pane: how much of the floor is explored, what is left to explore, and the columns found.

use super::look::{Look, fill, ranked};
use super::text;
use crate::model::survey::Survey;
use crate::model::{Model, Pane, Run};
use crate::theme::Role;
use exploration::Column;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use world::{Point, polyline};

/// Width of a label and of the bar on a narrow screen, columns.
const LABEL: usize = 11;
const BAR: usize = 8;
/// The minimum width at which the pane uses full words, columns.
const WIDE: usize = 40;

pub(super) fn draw(look: &Look, survey: &Survey, frame: &mut Frame, area: Rect) {
    let block = look.pane(Pane::Coverage, "Survey", "");
    let inner = block.inner(area);
    let (columns, rows) = (usize::from(inner.width), usize::from(inner.height));
    let mut lines = ranked(summary(look, survey, columns), rows);
    let room = rows.saturating_sub(lines.len());
    lines.extend(list(look.run, survey, room, columns).into_iter().map(|row| look.line([(Role::Text, row)])));
    fill(frame, area, block, lines);
}

/// The rows about the floor and the way.
fn summary(look: &Look, survey: &Survey, columns: usize) -> Vec<(u8, Line<'static>)> {
    let share = survey.share.map_or_else(|| "-".into(), text::percent);
    let bar = |width: usize| text::bar(survey.share.unwrap_or(0.0), width);
    let here = look.run.position.pose.map(|pose| pose.position);
    let label = if columns >= WIDE { LABEL } else { LABEL - 1 };
    let room = columns.saturating_sub(label + 2);
    let row = |rank: u8, name: &str, value: String| {
        (rank, look.line([(Role::Dim, format!(" {name:<label$}")), (Role::Text, value)]))
    };
    let explored = if columns >= WIDE {
        vec![
            row(0, "explored", format!("{share} % of the floor")),
            (4, look.line([(Role::Good, format!(" {}", bar(columns.saturating_sub(2))))])),
        ]
    } else {
        let bar = (Role::Good, format!(" {}", bar(BAR)));
        vec![(0, look.line([bar, (Role::Text, format!(" {share} % explored"))]))]
    };
    let mut lines = explored;
    lines.push(row(1, "frontiers", frontiers(look, survey, room)));
    lines.push(row(2, "way", way(look, survey, here, room)));
    let beyond = survey.way.as_ref().map_or(0, |way| way.beyond_tether);
    if beyond > 0 {
        lines.push(row(4, "left out", format!("{} beyond the tether", text::counted(beyond, "place"))));
    }
    lines.push(row(3, "columns", columns_found(look, survey, room)));
    lines
}

/// The number of columns, and the key with which the operator turns to their list.
fn columns_found(look: &Look, survey: &Survey, room: usize) -> String {
    let found = format!("{} found", survey.columns.len());
    let ui = &look.model.ui;
    let can_turn = ui.panes().contains(&Pane::Coverage) && ui.pane != Pane::Coverage;
    if survey.columns.is_empty() || !can_turn {
        return found;
    }
    text::wording([look.keys(&format!("{found}  <next-pane> list")), found], room)
}

/// The number of frontiers. The one to which the robot drives is at the end of its way.
fn frontiers(look: &Look, survey: &Survey, room: usize) -> String {
    match survey.frontiers.len() {
        // Before the first way, the scans have not been searched for frontiers.
        0 if survey.way.is_none() && !look.run.has_ended() => {
            text::wording(["not known yet".to_owned(), "-".to_owned()], room)
        }
        0 => {
            let unseen =
                survey.share.map(|share| format!("none left, {} % not seen", text::percent(1.0 - share)));
            text::wording([unseen.unwrap_or_default(), "none left".to_owned()], room)
        }
        n => n.to_string(),
    }
}

/// What is left of the way, and where it leads.
fn way(look: &Look, survey: &Survey, here: Option<Point>, room: usize) -> String {
    let Some(way) = &survey.way else {
        return if look.run.has_ended() { "ended".into() } else { "-".into() };
    };
    let left_m = here.map_or(way.length_m, |here| polyline::length_m(rest(&way.path, here)));
    let left = format!("{} m", text::number(left_m, 1));
    text::wording(
        [format!("{left} to {}", way.to.words()), format!("{left} to {}", way.to.word()), left],
        room,
    )
}

/// The part of a way that begins at its place nearest to the robot.
pub(in crate::view) fn rest(path: &[Point], here: Point) -> &[Point] {
    let nearest = super::map::nearest(path, here);
    path.get(nearest..).unwrap_or_default()
}

/// The columns, one in a row, by their numbers on the map; if they do not fit, the last row states how many are left out.
fn list(run: &Run, survey: &Survey, rows: usize, width: usize) -> Vec<String> {
    let mut all: Vec<(usize, &Column)> = run.column_numbers().into_iter().zip(&survey.columns).collect();
    all.sort_by_key(|(number, _)| *number);
    let all = all.into_iter().take(rows);
    let mut lines: Vec<String> = all.map(|(number, column)| row(number, column, width)).collect();
    let left_out = survey.columns.len() - lines.len();
    // The row above the list gives the number of columns; a list without a column would only repeat it.
    if left_out > 0 && lines.pop().is_some() && !lines.is_empty() {
        lines.push(format!(" and {} more, on the map", left_out + 1));
    }
    lines
}

/// A column: its number on the map, its centre and its radius, with their 95 % errors.
fn row(number: usize, column: &Column, width: usize) -> String {
    let place = text::place(column.center);
    let radius = text::number(column.radius_m, 2);
    let [center_m, radius_m] = column.errors_95_m().map(|error_m| text::number(error_m, 2));
    let number = format!(" {number:>2}");
    let wordings = [
        format!("{number}  {place} ±{center_m} m  radius {radius} ±{radius_m} m"),
        format!("{number}  {place} ±{center_m}, r {radius} ±{radius_m}"),
        format!("{number} {place} r {radius} ±{center_m}"),
    ];
    text::wording(wordings, width)
}

/// How much of the floor has been explored, as a sentence; `None` unless the mission is a survey.
pub(super) fn sentence(model: &Model) -> Option<String> {
    let survey = model.live.run.survey.as_ref()?;
    let share = survey.share.map_or_else(|| "-".into(), text::percent);
    Some(format!("{share} % of the floor explored, {} found.", text::counted(survey.columns.len(), "column")))
}
