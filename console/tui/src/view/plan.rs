//! The plan screen, for a mission before the start: the path on the map, the estimate, the changed parameters, and a
//! different planner's plan alongside.

mod estimate;
mod parameters;

use super::look::{Look, Parts, fill};
use super::{map, text};
use crate::model::ui::Arrangement;
use crate::theme::Role;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;

/// Width of the side panes on a wide and on a narrow screen, columns.
const SIDE: (u16, u16) = (50, 34);
/// Maximum number of rows for objections to a plan.
const REASONS: usize = 6;

pub(crate) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    if let Some(why) = &look.model.live.failure {
        return failure(look, frame, area, why);
    }
    let wide = arrangement == Arrangement::Wide;
    if arrangement == Arrangement::Paged {
        let [above, below] = Layout::vertical([Constraint::Length(5), Constraint::Fill(1)]).areas(area);
        state(look, frame, above);
        return estimate::draw(look, frame, below);
    }
    let side = if wide { SIDE.0 } else { SIDE.1 };
    let [left, right] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(side)]).areas(area);
    map::draw(look, frame, left);
    // The parameters get at least one row.
    let rows = if wide { 10 } else { 7 };
    let [top, middle, bottom] = Layout::vertical([
        Constraint::Length(rows),
        Constraint::Length(estimate::ROWS + 2),
        Constraint::Fill(1),
    ])
    .areas(right);
    state(look, frame, top);
    estimate::draw(look, frame, middle);
    parameters::draw(look, frame, bottom);
}

fn failure(look: &Look, frame: &mut Frame, area: Rect, why: &str) {
    let block = look.block(Role::Warn, "The scenario cannot be opened", "");
    let columns = usize::from(block.inner(area).width).saturating_sub(2);
    let lines = why.lines().flat_map(|line| text::wrap(line, columns));
    let lines = lines.map(|line| look.line([(Role::Text, format!(" {line}"))])).collect();
    fill(frame, area, block, lines);
}

/// Draws the planner, its progress, and the objections to its plan.
fn state(look: &Look, frame: &mut Frame, area: Rect) {
    let block = look.block(Role::Border, "Planner", &look.keys("<planner> change  <compare> compare"));
    let columns = usize::from(block.inner(area).width).saturating_sub(1);
    let name = match (look.model.planner(), look.run.planner_id()) {
        (Some(info), _) => format!("{} {}", info.id, info.version),
        (None, id) => id.unwrap_or("-").to_owned(),
    };
    let mut rows: Vec<Parts> = vec![vec![(Role::Title, format!(" {name}"))], vec![progress(look)]];
    rows.extend(certificate(look));
    let ghost = ghost(look, columns);
    let room = usize::from(block.inner(area).height).saturating_sub(rows.len() + ghost.len()).min(REASONS);
    let why = objections(look).into_iter().flat_map(|why| text::wrap(&why, columns)).collect();
    let why = text::first_lines(why, room, columns);
    rows.extend(why.into_iter().map(|line| vec![(Role::Warn, format!(" {line}"))]));
    rows.extend(ghost);
    let lines: Vec<Line> = rows.into_iter().map(|parts| look.line(parts)).collect();
    fill(frame, area, block, lines);
}

fn progress(look: &Look) -> (Role, String) {
    let planning = &look.run.planning;
    if let Some(fault) = &planning.fault {
        return (Role::Crit, format!(" FAILED: {}", fault.message));
    }
    match (&look.model.live.busy, &planning.plan) {
        (Some(busy), _) => {
            let share = busy.at.as_ref().map_or_else(String::new, |(share, what)| {
                format!(" {} %, {what}", (100.0 * share).floor().clamp(0.0, 99.0))
            });
            (Role::Watch, format!(" {}{share}", busy.work))
        }
        (None, Some(plan)) if plan.complete => (Role::Good, " plan ready".into()),
        (None, Some(_)) => (Role::Warn, " plan ready: PARTIAL, not the whole task".into()),
        (None, None) => (Role::Dim, " no plan".into()),
    }
}

fn certificate(look: &Look) -> Option<Parts> {
    look.run.about.as_ref()?.mission.tether.as_ref()?;
    Some(match look.run.tether.as_ref().and_then(|tether| tether.certified) {
        Some(true) => vec![(Role::Good, " certified for the tether".into())],
        Some(false) => vec![(Role::Crit, " NOT certified for the tether".into())],
        None => vec![(Role::Dim, " not certified for the tether yet".into())],
    })
}

/// The objections to the plan.
fn objections(look: &Look) -> Vec<String> {
    use crate::model::Cause;
    let alarms = look.run.alarms.list().iter();
    alarms
        .filter(|alarm| matches!(alarm.cause, Cause::Certificate | Cause::Planner))
        .map(|alarm| match alarm.text.split_once(": ") {
            // The line above already states that the plan is not certified.
            Some((_, why)) if alarm.cause == Cause::Certificate => text::capitalized(why),
            _ => alarm.text.clone(),
        })
        .collect()
}

/// The progress of the plan for comparison.
fn ghost(look: &Look, columns: usize) -> Vec<Parts> {
    let Some(ghost) = &look.model.live.plans.ghost else { return Vec::new() };
    let id = &ghost.choice.id;
    let (role, words) = match (&ghost.made, &ghost.at) {
        (Some(Err(why)), _) => (Role::Warn, format!("{id}: {why}")),
        (Some(Ok(_)), _) => (Role::Ghost, look.keys(&format!("compared with {id} (<cancel-plan>: remove)"))),
        (None, Some((share, _))) => {
            (Role::Watch, format!("Planning ({id}) {} %", (100.0 * share).floor().clamp(0.0, 99.0)))
        }
        (None, None) => (Role::Watch, format!("Planning ({id})")),
    };
    text::wrap(&words, columns).into_iter().map(|line| vec![(role, format!(" {line}"))]).collect()
}
