//! The alarm screen: alarms, their causes, and possible actions.

mod actions;
mod before;
mod detail;
mod rows;
mod table;
mod watched;

pub(super) use actions::list as action_list;
pub(super) use before::last_warnings;

use super::charts::{self, Series};
use super::look::{Look, fill};
use super::scroll::{self, Extent};
use super::small_map::{self, SmallMap};
use super::{events, text};
use crate::model::history::HISTORY_S;
use crate::model::ui::Arrangement;
use crate::model::{Alarm, Model, Overlay, Pane, Screen};
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use world::Point;

/// Width of the detail pane when the actions are beside it, columns.
const DETAIL: u16 = 72;
/// Minimum rows of the pane with an alarm's events, including the frame.
const EVENTS: u16 = 5;
/// Minimum rows of the table, including the frame.
const TABLE: u16 = 7;
/// Maximum rows of the table on a small screen, including the frame: two alarms.
const PAGED_TABLE: u16 = 6;
/// Maximum rows of the cause on a small screen.
const PAGED_CAUSE: usize = 2;
/// Minimum and preferred rows of the chart, including the frame.
const CHART: (u16, u16) = (7, 16);
/// The minimum columns and rows of the screen at which the details of an alarm are beside the
/// table.
const BESIDE: (u16, u16) = (170, 40);

pub(crate) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    match (look.model.selected_alarm(), arrangement) {
        (Some(alarm), Arrangement::Wide) if is_large(area) => {
            beside(look, frame, area, alarm);
        }
        (Some(alarm), Arrangement::Wide) => wide(look, frame, area, alarm),
        (Some(alarm), Arrangement::Narrow) => narrow(look, frame, area, alarm),
        (Some(alarm), Arrangement::Paged) => paged(look, frame, area, alarm),
        (None, _) => quiet(look, frame, area, arrangement),
        (Some(_), Arrangement::Strip) => table::draw(look, frame, area, arrangement),
    }
}

/// Without an alarm in the table, the rest of the screen shows the limits that are watched and the last warnings; a
/// large screen also shows the curves of the figures and the tank.
fn quiet(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let rows = if area.height > TABLE { TABLE - 2 } else { area.height };
    let [list, below] = Layout::vertical([Constraint::Length(rows), Constraint::Fill(1)]).areas(area);
    table::draw(look, frame, list, arrangement);
    let has_room = matches!(arrangement, Arrangement::Wide | Arrangement::Narrow);
    let [left, right] = Layout::horizontal([
        Constraint::Fill(1),
        Constraint::Length(if is_large(area) { rows::WIDTH - 20 } else { 0 }),
    ])
    .areas(below);
    let needed = if has_room { watched::rows(look) } else { 0 };
    let [limits, warnings] = Layout::vertical([Constraint::Length(needed), Constraint::Fill(1)]).areas(left);
    if needed > 0 {
        watched::draw(look, frame, limits);
    }
    // On a wide screen without room for curves beside the lists, they take the rows that the warnings do not need.
    let spare = match arrangement {
        Arrangement::Wide if right.width == 0 => warnings.height.saturating_sub(before::warning_rows(look)),
        _ => 0,
    };
    let spare = if spare < watched::LEAST_CURVE { 0 } else { spare };
    let [warnings, curves] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(spare)]).areas(warnings);
    if warnings.height > 0 {
        before::warnings(look, frame, warnings);
    }
    if curves.height > 0 {
        watched::curves_in_a_row(look, frame, curves);
    }
    if right.width > 0 {
        watched::curves(look, frame, right);
    }
}

/// How much of the details of the selected alarm is visible.
pub(crate) fn extent(look: &Look, area: Rect) -> Option<Extent> {
    let alarm = look.model.selected_alarm()?;
    let arrangement = look.model.ui.arrangement();
    Some(match arrangement {
        Arrangement::Wide if is_large(area) => {
            let len = detail::lines(look, alarm, usize::from(right_of(area).width) - 2).len();
            Extent { shown: len, len }
        }
        Arrangement::Wide => {
            let (about, len) = detail_rows(look, area, alarm);
            Extent { shown: usize::from(about.saturating_sub(2)), len }
        }
        Arrangement::Narrow | Arrangement::Paged | Arrangement::Strip => {
            let least = if arrangement == Arrangement::Narrow { least_table(look) } else { 0 };
            let shown = usize::from(area.height.saturating_sub(least + 2));
            let len = whole(look, alarm, area).len();
            Extent { shown: shown.min(len), len }
        }
    })
}

/// Whether the screen has room for the details of an alarm beside the table.
fn is_large(area: Rect) -> bool {
    area.width >= BESIDE.0 && area.height >= BESIDE.1
}

/// The part of a large screen beside the table.
fn right_of(area: Rect) -> Rect {
    Layout::horizontal([Constraint::Length(rows::WIDTH + 2), Constraint::Fill(1)]).areas::<2>(area)[1]
}

/// The least rows of the table on a narrow screen.
fn least_table(look: &Look) -> u16 {
    TABLE.min(table::rows(look, Arrangement::Narrow))
}

/// The details of an alarm and the actions on it.
fn whole(look: &Look, alarm: &Alarm, area: Rect) -> Vec<Line<'static>> {
    let columns = usize::from(area.width) - 2;
    [detail::lines(look, alarm, columns), actions::lines(look, alarm, columns)].concat()
}

/// On a small screen, the actions and the cause of the selected alarm are below the table; the operator turns to the
/// whole details.
fn paged(look: &Look, frame: &mut Frame, area: Rect, alarm: &Alarm) {
    if look.model.ui.focus() == Pane::Detail {
        let title = detail::title(look, alarm);
        return scroll::draw(look, frame, area, (&title, ""), whole(look, alarm, area));
    }
    let rows = table::rows(look, Arrangement::Paged).min(PAGED_TABLE);
    let [list, below] = Layout::vertical([Constraint::Length(rows), Constraint::Fill(1)]).areas(area);
    table::draw(look, frame, list, Arrangement::Paged);
    let columns = usize::from(below.width) - 2;
    let mut lines = detail::cause(look, alarm, columns, PAGED_CAUSE);
    let rows = usize::from(below.height).saturating_sub(2 + lines.len());
    lines.extend(actions::briefly(look, alarm, (columns, rows)));
    let title = detail::title(look, alarm);
    // The frame takes eight columns beside the title and the keys.
    let room = usize::from(below.width).saturating_sub(text::width(&title) + 8);
    let keys = ["<accept> actions  <next-pane> pane", "<accept> actions", ""].map(|keys| look.keys(keys));
    fill(frame, below, look.pane(Pane::Detail, &title, &text::wording(keys, room)), lines);
}

/// Whether the screen itself shows the actions, so that no overlay is needed.
pub(super) fn shows_actions(model: &Model) -> bool {
    let whole = matches!(model.ui.arrangement(), Arrangement::Wide | Arrangement::Narrow);
    whole && model.ui.screen == Screen::Alarms
}

/// Table and events on the left; the alarm with its actions, its chart and its place on the right.
fn beside(look: &Look, frame: &mut Frame, area: Rect, alarm: &Alarm) {
    let right = right_of(area);
    let left = Rect { width: area.width - right.width, ..area };
    let wanted = table::rows(look, Arrangement::Wide).max(TABLE).min(left.height - EVENTS);
    let [list, below] = Layout::vertical([Constraint::Length(wanted), Constraint::Fill(1)]).areas(left);
    table::draw(look, frame, list, Arrangement::Wide);
    let own = (alarm.events.len() as u16 + 2).clamp(EVENTS, below.height.div_ceil(2));
    let [own, around] = Layout::vertical([Constraint::Length(own), Constraint::Fill(1)]).areas(below);
    draw_events(look, frame, own, alarm);
    // Rows that the events do not need show the figures that are watched, as curves.
    let spare = around.height.saturating_sub(before::rows(look, around, alarm));
    let spare = if spare < watched::LEAST_CURVE { 0 } else { spare };
    let [around, curves] = Layout::vertical([Constraint::Fill(1), Constraint::Length(spare)]).areas(around);
    before::draw(look, frame, around, alarm);
    watched::curves_alone(look, frame, curves);
    let columns = usize::from(right.width) - 2;
    let (detail, actions) = (detail::lines(look, alarm, columns), actions::lines(look, alarm, columns));
    let chart = if is_charted(alarm) { CHART.1 } else { 0 };
    let [about, steps, curve, map] = Layout::vertical([
        Constraint::Length(detail.len() as u16 + 2),
        Constraint::Length(actions.len() as u16 + 2),
        Constraint::Length(chart),
        Constraint::Fill(1),
    ])
    .areas(right);
    draw_detail(look, frame, about, alarm, detail);
    fill(frame, steps, actions_block(look, alarm, "Actions"), actions);
    draw_chart(look, frame, curve, alarm);
    draw_place(look, frame, map, alarm.place);
}

/// The rows of the pane with the details of an alarm below the table, including the frame, and the rows of the details.
fn detail_rows(look: &Look, area: Rect, alarm: &Alarm) -> (u16, usize) {
    let detail = detail::lines(look, alarm, usize::from(DETAIL) - 2).len();
    let actions = actions::lines(look, alarm, usize::from(area.width.saturating_sub(DETAIL)) - 2);
    let chart = if is_charted(alarm) { CHART.0 } else { 0 };
    let about = (detail as u16 + 2).max(actions.len() as u16 + 2 + chart);
    (about.min(area.height.saturating_sub(EVENTS + TABLE)), detail)
}

fn wide(look: &Look, frame: &mut Frame, area: Rect, alarm: &Alarm) {
    let detail = detail::lines(look, alarm, usize::from(DETAIL) - 2);
    let actions = actions::lines(look, alarm, usize::from(area.width.saturating_sub(DETAIL)) - 2);
    let chart = if is_charted(alarm) { CHART.0 } else { 0 };
    let table = table::rows(look, Arrangement::Wide).max(TABLE);
    let about = detail_rows(look, area, alarm).0;
    let table = table.min(area.height.saturating_sub(EVENTS + about));
    let [list, middle, below] =
        Layout::vertical([Constraint::Length(table), Constraint::Length(about), Constraint::Fill(1)])
            .areas(area);
    let [left, right] = Layout::horizontal([Constraint::Length(DETAIL), Constraint::Fill(1)]).areas(middle);
    // The actions need all their rows; the chart gets the remaining rows.
    let rest = right.height.saturating_sub(actions.len() as u16 + 2);
    let chart = if chart > 0 && rest >= CHART.0 { rest } else { 0 };
    let [steps, curve] = Layout::vertical([Constraint::Fill(1), Constraint::Length(chart)]).areas(right);
    table::draw(look, frame, list, Arrangement::Wide);
    draw_detail(look, frame, left, alarm, detail);
    fill(frame, steps, actions_block(look, alarm, "Actions"), actions);
    draw_chart(look, frame, curve, alarm);
    // Rows that the events of the alarm do not need show what led to it.
    let own = (alarm.events.len() as u16 + 2).max(EVENTS - 1);
    let around = below.height.saturating_sub(own);
    let around = if around < EVENTS { 0 } else { around };
    let [own, around] = Layout::vertical([Constraint::Fill(1), Constraint::Length(around)]).areas(below);
    draw_events(look, frame, own, alarm);
    if around.height > 0 {
        before::draw(look, frame, around, alarm);
    }
}

fn narrow(look: &Look, frame: &mut Frame, area: Rect, alarm: &Alarm) {
    let columns = usize::from(area.width) - 2;
    let actions = actions::lines(look, alarm, columns);
    let least = least_table(look);
    if look.model.ui.focus() == Pane::Detail {
        let [list, below] = Layout::vertical([Constraint::Length(least), Constraint::Fill(1)]).areas(area);
        table::draw(look, frame, list, Arrangement::Narrow);
        let title = detail::title(look, alarm);
        return scroll::draw(look, frame, below, (&title, ""), whole(look, alarm, area));
    }
    let rows = usize::from(area.height.saturating_sub(least + 2)).saturating_sub(actions.len());
    let mut lines = detail::lines(look, alarm, columns);
    let is_cut = lines.len() > rows;
    lines.truncate(rows);
    lines.extend(actions);
    let rows = lines.len() as u16 + 2;
    let [list, below] = Layout::vertical([Constraint::Fill(1), Constraint::Length(rows)]).areas(area);
    table::draw(look, frame, list, Arrangement::Narrow);
    let more = if is_cut { look.keys("  <next-pane> pane: all") } else { String::new() };
    let note = format!("{}{more}", actions_note(look, alarm));
    fill(frame, below, look.pane(Pane::Detail, &detail::title(look, alarm), &note), lines);
}

fn draw_detail(look: &Look, frame: &mut Frame, area: Rect, alarm: &Alarm, lines: Vec<Line<'_>>) {
    let map = alarm.place.map_or_else(String::new, |_| look.keys("<show-place> map"));
    scroll::draw(look, frame, area, (&detail::title(look, alarm), &map), lines);
}

/// The keys that run the actions.
fn actions_note(look: &Look, alarm: &Alarm) -> String {
    let is_open = matches!(look.model.ui.overlay, Overlay::Remedies { .. });
    match (actions::keys(look, &alarm.cause), is_open) {
        (Some(keys), true) => format!("{keys} run"),
        (Some(keys), false) => format!("{}, then {keys}", look.keys("<accept>")),
        (None, _) => "advice only".to_owned(),
    }
}

fn actions_block<'t>(look: &Look, alarm: &Alarm, title: &str) -> ratatui::widgets::Block<'t> {
    let is_open = matches!(look.model.ui.overlay, Overlay::Remedies { .. });
    look.block(if is_open { Role::Focus } else { Role::Border }, title, &actions_note(look, alarm))
}

/// Whether the figure of an alarm can be drawn as a curve.
fn is_charted(alarm: &Alarm) -> bool {
    alarm.history.last(HISTORY_S).nth(1).is_some()
}

/// The figure of an alarm over the last minutes, with the limit of the alarm.
fn draw_chart(look: &Look, frame: &mut Frame, area: Rect, alarm: &Alarm) {
    if area.height < CHART.0 || !is_charted(alarm) {
        return;
    }
    let mut readings = [&alarm.reading, &alarm.peak].into_iter().flatten();
    let limit = readings.find_map(|reading| reading.numbers?.1);
    let largest = alarm.history.last(HISTORY_S).fold(0.0, f64::max);
    let decimals = match largest.max(limit.unwrap_or(0.0)) {
        most if most < 10.0 => 2,
        most if most < 100.0 => 1,
        _ => 0,
    };
    let series =
        Series { title: detail::figure(&alarm.cause), values: &alarm.history, now: None, limit, decimals };
    charts::figure(look, frame, area, &series);
}

/// The place of an alarm, if there is one, and the robot on a small map.
fn draw_place(look: &Look, frame: &mut Frame, area: Rect, place: Option<Point>) {
    let Some(map) = SmallMap::of_run(look.run, look.model.live.together()) else { return };
    let robot = look.run.position.pose.as_ref().map(|pose| pose.position);
    let map = robot.into_iter().fold(map, |map, at| map.marked(at, Role::Robot, "@"));
    let (map, title) = match place {
        Some(place) => (map.marked(place, Role::Warn, "X"), format!("Place  X {}", text::place(place))),
        None => (map, "Tank".to_owned()),
    };
    let block = look.block(Role::Border, &format!("{title}, robot @"), "");
    let inner = block.inner(area);
    frame.render_widget(block, area);
    small_map::draw(look, frame, inner, &map);
}

/// The last log lines about an alarm, newest first.
fn draw_events(look: &Look, frame: &mut Frame, area: Rect, alarm: &Alarm) {
    let block = look.block(Role::Border, "Events of this alarm", &look.keys("<events> all events"));
    let inner = block.inner(area);
    let entries = alarm.events.iter().rev().filter_map(|number| look.run.log.get(*number));
    let size = (usize::from(inner.width), usize::from(inner.height));
    let lines = events::in_rows(entries, size).into_iter().map(|parts| look.line(parts)).collect();
    fill(frame, area, block, lines);
}
