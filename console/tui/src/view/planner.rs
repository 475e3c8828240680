//! The planner pane: the active planner, its target, and the last command.

use super::look::{Look, fill, marked, ranked};
use super::{shadow, text};
use crate::model::history::HISTORY_S;
use crate::model::{Offer, Pane, Run, parameter};
use crate::theme::Role;
use planner_api::{Drive, Status};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Maximum number of rows for a fault.
const FAULT_ROWS: usize = 2;
/// Width of the name of a planner's figure, columns.
const SCALAR: usize = 22;
/// Width of a planner's figure before its curve, and the minimum width of the curve, columns.
const FIGURE: usize = 14;
const CURVE: usize = 8;
/// Minimum width, in columns, at which labels are written out in full.
const WIDE: usize = 40;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let note = if look.run.planning.fault.is_some() { "FAILED" } else { "" };
    let block = look.pane(Pane::Planner, "Planner and robot", note);
    let inner = block.inner(area);
    let (columns, rows) = (usize::from(inner.width), usize::from(inner.height));
    let labels = if columns >= WIDE { 12 } else { 8 };
    let room = columns.saturating_sub(labels + 1);
    let lines = rows_of(look, columns >= WIDE, room)
        .into_iter()
        .map(|(rank, label, (role, value))| {
            (rank, look.line([(Role::Dim, format!(" {label:<labels$}")), (role, value)]))
        })
        .collect();
    let mut lines = ranked(lines, rows);
    lines.extend(scalars(look, columns, rows.saturating_sub(lines.len())));
    fill(frame, area, block, lines);
}

type Value = (Role, String);

fn rows_of(look: &Look, wide: bool, room: usize) -> Vec<(u8, &'static str, Value)> {
    let run = look.run;
    let is_stale = look.is_pose_stale();
    let pose = |value: String| marked(is_stale, (Role::Text, value));
    // The active planner's name is also in the top line, so the differences of the planner in shadow rank higher.
    let of_name = if run.shadow.is_some() { 3 } else { 2 };
    let mut rows = vec![(of_name, "planner", planner(look))];
    if let Some(fault) = &run.planning.fault {
        let words = text::wrap(&fault.message, room + 1).into_iter().take(FAULT_ROWS).zip([2_u8, 7]);
        rows.extend(
            words.map(|(words, rank)| (rank, if rank == 2 { "fault" } else { "" }, (Role::Crit, words))),
        );
    }
    rows.extend(shadow::rows(look, room));
    rows.extend(run.planning.offer.iter().map(|offer| (2, "better", better(look, offer, room))));
    rows.extend([
        (0, "speed", pose(motion(run, room))),
        (1, "command", command(look, room)),
        (3, "target", (Role::Text, target(run, room))),
        (4, if wide { "cross-track" } else { "off path" }, (Role::Text, cross_track(run, room))),
        (5, "plan", (Role::Text, plan(run))),
    ]);
    // Without a preset path, nothing can be off it; the pane about a survey shows its way.
    let has_preset = run.about.as_ref().is_none_or(|about| about.preset_m.is_some());
    rows.retain(|(_, label, _)| match *label {
        "plan" => !run.is_survey(),
        "cross-track" | "off path" => has_preset && !run.is_survey(),
        _ => true,
    });
    rows
}

/// The better plan on offer: what it saves, and the key that takes it.
fn better(look: &Look, offer: &Offer, room: usize) -> Value {
    let saves = text::number((offer.flown.time_s - offer.better.time_s) / 60.0, 1);
    let of = text::number(offer.flown.time_s / 60.0, 1);
    let next = if offer.is_taken { "taken".to_owned() } else { look.keys("<take-plan>: take") };
    let words = [format!("saves {saves} of {of} min; {next}"), format!("-{saves} min; {next}"), next];
    (Role::Watch, text::wording(words, room))
}

fn planner(look: &Look) -> Value {
    if look.run.is_survey() {
        return (Role::Title, "the mission itself drives".into());
    }
    match (look.model.planner(), look.run.planner_id()) {
        (Some(info), _) => {
            let changed = parameter::changed(info, look.run.planning.choice.as_ref());
            let mark = if changed > 0 { format!("*, {changed} changed") } else { String::new() };
            (Role::Title, format!("{} {}{mark}", info.id, info.version))
        }
        (None, Some(id)) => (Role::Title, id.to_owned()),
        (None, None) => (Role::Text, "-".into()),
    }
}

fn target(run: &Run, room: usize) -> String {
    let Some(progress) = &run.progress else { return "-".into() };
    let at = text::place(progress.target);
    let Some(pose) = &run.position.pose else { return at };
    let away = text::number((progress.target - pose.position).norm(), 2);
    text::wording([format!("{at}, {away} m away"), at, format!("{away} m away")], room)
}

fn cross_track(run: &Run, room: usize) -> String {
    let off_m = run.progress.as_ref().and_then(|progress| progress.cross_track_m);
    let off = off_m.map_or_else(|| "-".into(), |off_m| text::number(off_m, 2));
    text::wording([format!("{off} m from preset path"), format!("{off} m")], room)
}

/// The estimated speed and heading.
fn motion(run: &Run, room: usize) -> String {
    let heading = run.position.pose.map_or_else(|| "-".into(), |pose| text::degrees(pose.heading_rad));
    if run.has_ended() {
        return text::wording([format!("standing, heading {heading}° CCW from E"), "standing".into()], room);
    }
    let speed = run.speed_m_per_s().map_or_else(|| "-".into(), |speed| text::number(speed, 2));
    text::wording(
        [
            format!("{speed} m/s, heading {heading}° CCW from E"),
            format!("{speed} m/s, heading {heading}°"),
            format!("{speed} m/s, {heading}° CCW"),
        ],
        room,
    )
}

/// The last command, marked if it is stale, because the robot does not follow an old command for long.
fn command(look: &Look, room: usize) -> Value {
    let run = look.run;
    let Some((t_s, command)) = &run.planning.command else { return (Role::Text, "-".into()) };
    if !run.is_running() {
        return (Role::Text, "standing still".into());
    }
    let (full, short) = match command.drive {
        Drive::Twist { v_m_per_s, w_rad_per_s } => {
            let (speed, turn) = (text::number(v_m_per_s, 2), text::number(w_rad_per_s.to_degrees(), 1));
            let unit = look.caps.glyphs.turn_unit();
            (format!("{speed} m/s, turn {turn} {unit}"), format!("{speed} m/s {turn} {unit}"))
        }
        Drive::Velocity(velocity) => {
            let speed = text::number(velocity.norm(), 2);
            let course = text::degrees(velocity.y.atan2(velocity.x));
            (format!("{speed} m/s to {course}° CCW from E"), format!("{speed} m/s {course}°"))
        }
    };
    let (role, status) = match command.status {
        Status::Moving => (Role::Text, ""),
        Status::Arrived => (Role::Good, "arrived"),
        Status::Stuck => (Role::Warn, "STUCK"),
        Status::Waiting => (Role::Watch, "waiting"),
    };
    let comma = if status.is_empty() { "" } else { ", " };
    let wordings = [format!("{status}{comma}{full}"), format!("{status}{comma}{short}"), status.to_owned()];
    // The stale mark takes one column.
    let words = text::wording(wordings, room.saturating_sub(1));
    marked(look.is_stale(Some(*t_s)), (role, words))
}

fn plan(run: &Run) -> String {
    let Some(plan) = &run.planning.plan else { return "none yet".into() };
    let part = if plan.complete { "full" } else { "PARTIAL" };
    format!("{} m ({part})", text::number(plan.length_m, 1))
}

fn scalars(look: &Look, columns: usize, rows: usize) -> Vec<Line<'static>> {
    // A count of zero is left out, because it tells the operator nothing.
    let says = |scalar: &&(String, f64, String)| !(scalar.1 == 0.0 && scalar.2.is_empty());
    let shown = look.run.planning.scalars.iter().filter(says).take(rows);
    shown
        .map(|(name, value, unit)| {
            let label = text::column(&format!(" {name}"), SCALAR.min(columns / 2 + 2));
            let room = columns.saturating_sub(text::width(&label) + 1);
            let figure = figure(*value, unit);
            let curve = curve(look, name, room.saturating_sub(FIGURE.max(text::width(&figure) + 1)));
            let width = if curve.is_empty() { room } else { FIGURE.max(text::width(&figure) + 1) };
            look.line([
                (Role::Dim, format!("{label} ")),
                (Role::Text, text::column(&text::fit(&figure, room), width)),
                (Role::Watch, curve),
            ])
        })
        .collect()
}

/// The curve of a figure over the last minutes, up to its largest value; empty if the room is too small or the figure
/// has negative values.
fn curve(look: &Look, name: &str, room: usize) -> String {
    let history = look.run.planning.scalar_history.get(name).filter(|_| room >= CURVE);
    let Some(history) = history else { return String::new() };
    let largest = history.last(HISTORY_S).fold(0.0, f64::max);
    let is_drawn = largest > 0.0 && history.last(HISTORY_S).all(|value| value >= 0.0);
    if !is_drawn {
        return String::new();
    }
    text::sparkline(history, HISTORY_S, largest, room)
}

/// A figure of the planner; a count has no decimals.
fn figure(value: f64, unit: &str) -> String {
    let decimals = if unit.is_empty() && value.fract() == 0.0 { 0 } else { 3 };
    format!("{} {unit}", text::number(value, decimals)).trim_end().to_owned()
}
