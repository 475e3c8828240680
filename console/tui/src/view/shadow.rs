//! The planner in shadow, as shown in the planner pane: whether it is ready to take over, and how it differs from the
//! active planner.

use super::look::Look;
use super::text;
use crate::model::{Run, Shadow, shadow::GHOST_S};
use crate::theme::Role;
use mission::{Phase, event::READY_AFTER};

/// The rows for the planner pane, each with its rank; empty without a planner in shadow.
pub(super) fn rows(look: &Look, room: usize) -> Vec<(u8, &'static str, (Role, String))> {
    let run = look.run;
    let Some(shadow) = &run.shadow else { return Vec::new() };
    let mut rows = vec![(2, "shadow", (Role::Ghost, text::wording(state(shadow, run), room)))];
    if let Some(by) = run.shadow_differences() {
        let speed = signed(by.speed_m_per_s, 2);
        let turn = signed(by.turn_rad_per_s.to_degrees(), 0);
        let (clearance, here) = (text::number(by.clearance_m, 2), text::number(by.here_m, 2));
        let unit = look.caps.glyphs.turn_unit();
        let commands = [format!("{speed} m/s, turn {turn} {unit}"), format!("{speed} m/s {turn} {unit}")];
        let clear = [
            format!("{clearance} m in {GHOST_S} s, here {here} m"),
            format!("{clearance} m, here {here} m"),
            format!("{clearance} m"),
        ];
        rows.push((2, "differs", (Role::Text, text::wording(commands, room))));
        rows.push((3, "clear", (Role::Text, text::wording(clear, room))));
    }
    rows
}

/// A difference, with its sign.
fn signed(value: f64, decimals: usize) -> String {
    let sign = if value < 0.0 { "-" } else { "+" };
    format!("{sign}{}", text::number(value.abs(), decimals))
}

/// Whether the planner is ready to take over, and how many steps it has missed, from the longest wording to the
/// shortest.
fn state(shadow: &Shadow, run: &Run) -> [String; 4] {
    let is_held = matches!(run.standing.phase, Phase::Held(_));
    let (id, tally) = (&shadow.choice.id, &shadow.tally);
    let state = match &shadow.info {
        None => "opening".to_owned(),
        Some(_) if shadow.is_promoted => "taking over".to_owned(),
        Some(_) if tally.is_ready() => "ready".to_owned(),
        Some(_) if shadow.path.is_empty() => "planning".to_owned(),
        // While the robot is held, a plan is enough.
        Some(_) if is_held => "ready".to_owned(),
        Some(_) if tally.answered == 0 => "planned".to_owned(),
        Some(_) => format!("{} of {READY_AFTER} steps", tally.in_row),
    };
    let version = shadow.info.as_ref().map_or_else(String::new, |info| format!(" {}", info.version));
    let missed = tally.missed;
    [
        format!("{id}{version}, {state}, {missed} missed of {}", tally.answered + missed),
        format!("{id}, {state}, {missed} missed"),
        format!("{state}, {missed} missed"),
        state,
    ]
}
