//! The top line: who is in control, what is running, whether it is being recorded, and the alarms.

use super::look::{Look, Parts};
use super::text;
use crate::model::{Model, Recording, ui::Arrangement};
use crate::theme::Role;
use mission::{Gait, Hold, HoldReason, Outcome, Phase, Severity};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use world::Boundary;

/// Width of the tank and planner names below which the alarm words are reduced to letters, columns.
const LEAST_NAMES: usize = 24;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let arrangement = Arrangement::of(frame.area().width, frame.area().height);
    let wide = arrangement == Arrangement::Wide;
    let gap = if wide { "   " } else { " " };
    let state = state(look.model);
    let time = time(look.model);
    // The names get the remaining columns. The tank's name is dropped first, because the planner can change.
    let screen = look.model.ui.screen;
    let name = format!("{} {} ", screen.digit(), screen.name());
    let screen = if wide { text::width(&name) + gap.len() } else { 0 };
    let sum = |parts: &Parts| parts.iter().map(|(_, text)| text::width(text)).sum::<usize>();
    let beside = 1 + 4 * gap.len() + sum(&state) + sum(&time) + screen;
    let room = |alarms: &Parts| usize::from(area.width).saturating_sub(beside + sum(alarms));
    let words = alarms(look.model, wide);
    let alarms = if room(&words) < LEAST_NAMES { alarms(look.model, false) } else { words };
    let room = room(&alarms);
    let names = names(look.model, wide, gap, room);
    let blank = || vec![(Role::Text, gap.to_owned())];
    let left = [vec![(Role::Text, " ".into())], state, blank(), names, time, blank(), alarms].concat();
    let used: usize = left.iter().map(|(_, text)| text::width(text)).sum();
    frame.render_widget(look.line(left), area);
    // The names on the left are cut before the screen name is dropped.
    if wide && used + screen <= usize::from(area.width) {
        let width = text::width(&name) as u16;
        let line = Line::from(look.span(Role::Dim, name)).right_aligned();
        frame.render_widget(line, right_of(area, width));
    }
}

fn right_of(area: Rect, width: u16) -> Rect {
    let width = width.min(area.width);
    Rect { x: area.right() - width, width, ..area }
}

/// Who is in control, and whether the robot moves.
pub(super) fn state(model: &Model) -> Parts {
    if let Some(replay) = &model.live.replay {
        let word = if replay.is_playing { "▶ PLAY" } else { "‖ PAUSE" };
        return vec![(Role::Selected, "REPLAY".into()), (Role::Title, format!(" {word}"))];
    }
    let (who, role, word) = match model.live.run.phase() {
        Phase::Waiting => ("OPER", Role::Title, "■ IDLE"),
        Phase::Running(Gait::Steady) => ("AUTO", Role::Run, "▶ RUN"),
        Phase::Running(Gait::OneTick | Gait::To(_)) => ("OPER", Role::Run, "▶ STEP"),
        Phase::Held(_) if model.live.run.is_live() => ("LIVE", held_role(model), held_word(model)),
        Phase::Held(Hold {
            by: HoldReason::Operator | HoldReason::Stepped | HoldReason::PlannerReplaced,
            ..
        }) => ("OPER", Role::Hold, "‖ HOLD"),
        Phase::Held(_) => ("AUTO", Role::Hold, "‖ HOLD"),
        Phase::Ended(Outcome::Complete) => ("OPER", Role::Good, "✓ DONE"),
        Phase::Ended(_) => ("OPER", Role::Warn, "■ ENDED"),
    };
    let (role, word) = if model.live.is_cut_off { (Role::Crit, "■ CUT OFF") } else { (role, word) };
    let who = if model.live.run.is_live() { "LIVE" } else { who };
    let who = if model.live.is_look_only() { "VIEW" } else { who };
    vec![(Role::Title, format!("{who} ")), (role, word.into())]
}

/// Whether a held vehicle really stands.
fn stands(model: &Model) -> Option<bool> {
    model.live.run.vehicle.as_ref().and_then(|vehicle| vehicle.stands)
}

fn held_role(model: &Model) -> Role {
    if stands(model) == Some(false) { Role::Crit } else { Role::Hold }
}

fn held_word(model: &Model) -> &'static str {
    match stands(model) {
        Some(true) => "‖ HELD",
        Some(false) => "‖ STOP NOT CONFIRMED",
        None => "‖ STOPPING",
    }
}

fn names(model: &Model, wide: bool, gap: &str, room: usize) -> Parts {
    let planner = match (wide, model.planner(), model.live.run.planner_id()) {
        (true, Some(info), _) => format!("{} {}", info.id, info.version),
        (_, _, Some(id)) => id.to_owned(),
        _ => String::new(),
    };
    let tank = model.live.run.about.as_ref().map_or_else(
        || "no run".into(),
        |run| match (&run.world.boundary, wide) {
            (Boundary::Circle { radius_m }, true) => {
                format!("{} Ø{} m", run.scenario, text::number(2.0 * radius_m, 0))
            }
            _ => run.scenario.clone(),
        },
    );
    let planner = text::fit(&planner, room);
    let left = room.saturating_sub(text::width(&planner));
    let parts = [
        (Role::Text, if left >= 4 { text::fit(&tank, left) } else { String::new() }),
        (Role::Title, planner),
    ];
    parts
        .into_iter()
        .filter(|(_, text)| !text.is_empty())
        .flat_map(|part| [part, (Role::Text, gap.into())])
        .collect()
}

/// The mission time, speed and recording.
pub(super) fn time(model: &Model) -> Parts {
    let clock = match model.silent_s() {
        Some(silent_s) => {
            (Role::Stale, format!("◌T+{} {} s old ", text::clock(model.live.run.clock.t_s), silent_s as u64))
        }
        None => (Role::Text, format!("T+{} ", text::clock(model.live.run.clock.t_s))),
    };
    // The speed is the replay speed; no robot is connected.
    if model.live.is_replay() {
        return vec![clock, (Role::Text, format!("{} ", text::speed(model.live.speed)))];
    }
    // The journal records neither the speed of its mission nor whether the mission was being recorded.
    if model.live.is_look_only() {
        return vec![clock];
    }
    vec![clock, (Role::Text, format!("{} ", text::speed(model.live.speed))), recording(model)]
}

fn recording(model: &Model) -> (Role, String) {
    match model.live.health.recording {
        _ if model.live.result.as_ref().is_some_and(|result| result.is_kept) => {
            (Role::Good, "REC saved".into())
        }
        Recording::On => (Role::Good, "REC●".into()),
        Recording::Off => (Role::Dim, "REC-".into()),
        Recording::Failed(_) => (Role::Crit, "REC✗".into()),
    }
}

/// The number of alarms of each severity, marked if any of them are unacknowledged.
pub(super) fn alarms(model: &Model, wide: bool) -> Parts {
    if model.live.run.alarms.open().next().is_none() {
        return vec![(Role::Dim, if wide { "ALARM none" } else { "! none" }.into())];
    }
    let counted = [
        (Severity::Crit, Role::Crit, "crit", "C"),
        (Severity::Warn, Role::Warn, "warn", "W"),
        (Severity::Watch, Role::Watch, "watch", "w"),
    ];
    let mut parts = vec![(Role::Title, if wide { "ALARM".into() } else { "!".into() })];
    for (severity, role, word, letter) in counted {
        let (count, open) =
            (model.live.run.alarms.count(severity), model.live.run.alarms.unacknowledged(severity) > 0);
        let role = if count == 0 { Role::Dim } else { role };
        parts.push((Role::Text, " ".into()));
        parts.push((
            role,
            match (wide, open) {
                (true, true) => format!("{count} {word}(unack)"),
                (true, false) => format!("{count} {word}"),
                (false, true) => format!("{count}{letter}*"),
                (false, false) => format!("{count}{letter}"),
            },
        ));
    }
    parts
}
