//! The planner pane: the active planner, its target, and the last command.

use super::look::{Look, fill};
use super::text;
use crate::model::{Pane, Run};
use crate::theme::Role;
use planner_api::{Drive, Status};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Mission time after which a command counts as old, in ticks.
const STALE_TICKS: f64 = 3.0;

/// Most rows that a fault takes.
const FAULT_ROWS: usize = 2;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, wide: bool) {
    let note = if look.run.planning.fault.is_some() { "FAILED" } else { "" };
    let block = look.pane(Pane::Planner, "Planner and robot", note);
    let inner = block.inner(area);
    let (columns, rows) = (usize::from(inner.width), usize::from(inner.height));
    let labels = if wide { 12 } else { 8 };
    let room = columns.saturating_sub(labels + 1);
    let mut lines: Vec<Line> = rows_of(look, wide, room)
        .into_iter()
        .map(|(label, (role, value))| {
            look.line([(Role::Dim, format!(" {label:<labels$}")), (role, text::fit(&value, room))])
        })
        .collect();
    lines.extend(scalars(look, columns, rows.saturating_sub(lines.len())));
    fill(frame, area, block, lines);
}

type Value = (Role, String);

fn rows_of(look: &Look, wide: bool, room: usize) -> Vec<(&'static str, Value)> {
    let run = look.run;
    let mut rows = vec![("planner", planner(look))];
    if let Some(fault) = &run.planning.fault {
        let words = text::wrap(&fault.message, room + 1).into_iter().take(FAULT_ROWS);
        rows.extend(
            words.enumerate().map(|(row, words)| (if row == 0 { "fault" } else { "" }, (Role::Crit, words))),
        );
    }
    if wide {
        rows.extend([
            ("target", (Role::Text, target(run))),
            ("cross-track", (Role::Text, cross_track(run))),
            ("speed", (Role::Text, speed(run))),
            ("heading", (Role::Text, heading(run))),
            ("command", command(run)),
            ("plan", (Role::Text, plan(run))),
        ]);
    } else {
        rows.extend([
            ("target", (Role::Text, target_at(run))),
            ("away", (Role::Text, format!("{}, off {}", target_in(run), off(run)))),
            ("speed", (Role::Text, speed(run))),
            ("heading", (Role::Text, heading(run))),
            ("plan", (Role::Text, plan(run))),
        ]);
    }
    rows
}

fn planner(look: &Look) -> Value {
    match (look.model.planner(), look.run.planner_id()) {
        (Some(info), _) => (Role::Title, format!("{} {}", info.id, info.version)),
        (None, Some(id)) => (Role::Title, id.to_owned()),
        (None, None) => (Role::Text, "-".into()),
    }
}

fn target(run: &Run) -> String {
    let away = || format!("{}, {} away", target_at(run), target_in(run));
    run.progress.as_ref().map_or_else(|| "-".into(), |_| away())
}

fn target_at(run: &Run) -> String {
    run.progress.as_ref().map_or_else(|| "-".into(), |progress| text::place(progress.target))
}

fn target_in(run: &Run) -> String {
    match (&run.progress, &run.position.pose) {
        (Some(progress), Some(pose)) => {
            format!("{} m", text::number((progress.target - pose.position).norm(), 2))
        }
        _ => "- m".into(),
    }
}

fn off(run: &Run) -> String {
    let off_m = run.progress.as_ref().and_then(|progress| progress.cross_track_m);
    format!("{} m", off_m.map_or_else(|| "-".into(), |off_m| text::number(off_m, 2)))
}

fn cross_track(run: &Run) -> String {
    let preset = run.about.as_ref().is_none_or(|about| about.preset_m.is_some());
    if preset { format!("{} from preset path", off(run)) } else { "- (no preset path)".into() }
}

fn speed(run: &Run) -> String {
    let speed = run.position.speed_m_per_s();
    speed.map_or_else(|| "- m/s".into(), |speed| format!("{} m/s (est.)", text::number(speed, 2)))
}

fn heading(run: &Run) -> String {
    let pose = run.position.pose.as_ref();
    pose.map_or_else(|| "-".into(), |pose| format!("{}° CCW from E", text::degrees(pose.heading_rad)))
}

fn command(run: &Run) -> Value {
    let Some((t_s, command)) = &run.planning.command else { return (Role::Text, "-".into()) };
    let tick_s = run.about.as_ref().map_or(0.1, |about| about.mission.tick_s);
    if !run.is_running() || run.clock.t_s - t_s > STALE_TICKS * tick_s {
        return (Role::Text, "standing still".into());
    }
    let drive = match command.drive {
        Drive::Twist { v_m_per_s, w_rad_per_s } => {
            let turn = text::number(w_rad_per_s.to_degrees(), 1);
            format!("{} m/s, turn {turn} °/s", text::number(v_m_per_s, 2))
        }
        Drive::Velocity(velocity) => {
            let course = text::degrees(velocity.y.atan2(velocity.x));
            format!("{} m/s to {course}° CCW from E", text::number(velocity.norm(), 2))
        }
    };
    match command.status {
        Status::Moving => (Role::Text, drive),
        Status::Arrived => (Role::Good, format!("arrived, {drive}")),
        Status::Stuck => (Role::Warn, format!("STUCK, {drive}")),
        Status::Waiting => (Role::Watch, format!("waiting, {drive}")),
    }
}

fn plan(run: &Run) -> String {
    let Some(plan) = &run.planning.plan else { return "none yet".into() };
    let part = if plan.complete { "full" } else { "PARTIAL" };
    format!("{} m ({part})", text::number(plan.length_m, 1))
}

fn scalars(look: &Look, columns: usize, rows: usize) -> Vec<Line<'static>> {
    let shown = look.run.planning.scalars.iter().take(rows);
    shown
        .map(|(name, value, unit)| {
            let unit = if unit.is_empty() { "[-]" } else { unit.as_str() };
            let label = text::column(&format!(" {name}"), 13.min(columns / 2));
            let value =
                text::fit(&format!("{} {unit}", text::number(*value, 3)), columns - label.len().min(columns));
            look.line([(Role::Dim, label), (Role::Text, value)])
        })
        .collect()
}
