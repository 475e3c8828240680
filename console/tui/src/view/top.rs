//! The top line: who is in control, what is running, whether it is being recorded, and the alarms.

use super::look::{Look, Parts};
use super::tabs::{self, Form};
use super::text;
use crate::model::{Model, Recording, ui::Arrangement};
use crate::theme::Role;
use mission::{Gait, Outcome, Phase, Severity};
use ratatui::Frame;
use ratatui::layout::Rect;
use world::Boundary;

/// The minimum width of a terminal at which the counts of alarms are spelled out, columns.
const LONG_ALARMS: u16 = 160;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let model = look.model;
    let wide = Arrangement::of(frame.area().width, frame.area().height) == Arrangement::Wide;
    let gap = if wide { "   " } else { " " };
    let (state, time, names) = (state(model), time(model), Names::of(model));
    let sum = |parts: &Parts| parts.iter().map(|(_, text)| text::width(text)).sum::<usize>();
    let fixed = 1 + 3 * gap.len() + sum(&state) + sum(&time);
    let columns = usize::from(area.width).saturating_sub(fixed);
    let alarms_in = |long| Some(alarms(model, long)).filter(|alarms| sum(alarms) + names.width() <= columns);
    let alarms = alarms_in(area.width >= LONG_ALARMS).unwrap_or_else(|| alarms(model, false));
    let room = columns.saturating_sub(sum(&alarms));
    let scenario = text::fit(&names.scenario, room);
    let mut room = room - text::width(&scenario);
    // An item that does not fit beside the scenario is left out completely.
    let mut fits = |columns: usize| {
        let fits = columns <= room;
        room -= if fits { columns } else { 0 };
        fits
    };
    let form_width = |form| tabs::width(model, form);
    let has_screen = !tabs::has_row(frame.area()) && fits(form_width(Form::Current) + 1);
    let more = form_width(Form::Digits) - form_width(Form::Current);
    let mut planner = names.planner.clone();
    if !planner.is_empty() {
        planner.insert_str(0, gap);
    }
    if !fits(text::width(&planner)) {
        planner.clear();
    }
    let has_version = wide && !planner.is_empty() && fits(text::width(&names.version));
    let has_size = wide && fits(text::width(&names.size));
    let form = if has_screen && fits(more) { Form::Digits } else { Form::Current };
    let blank = || vec![(Role::Text, gap.to_owned())];
    let named = vec![
        (Role::Text, if has_size { scenario + &names.size } else { scenario }),
        (Role::Title, if has_version { planner + &names.version } else { planner }),
    ];
    let line =
        [vec![(Role::Text, " ".into())], state, blank(), named, blank(), time, blank(), alarms].concat();
    frame.render_widget(look.line(line), area);
    if has_screen {
        tabs::draw(look, frame, right_of(area, form_width(form) as u16), form);
    }
}

fn right_of(area: Rect, width: u16) -> Rect {
    let width = width.min(area.width);
    Rect { x: area.right() - width, width, ..area }
}

/// The names of the scenario and the planner.
struct Names {
    scenario: String,
    /// The size of the tank, after the scenario; empty for a tank that is not round.
    size: String,
    planner: String,
    /// The planner's version, after its name.
    version: String,
}

impl Names {
    fn of(model: &Model) -> Self {
        let run = &model.live.run;
        let about = run.about.as_ref();
        let size = match about.map(|about| &about.world.boundary) {
            Some(Boundary::Circle { radius_m }) => format!(" Ø{} m", text::number(2.0 * radius_m, 0)),
            _ => String::new(),
        };
        let planner = run.planner_id().unwrap_or_default().to_owned();
        let version = model.planner().map_or_else(String::new, |info| format!(" {}", info.version));
        let scenario = about.map_or_else(|| "no run".to_owned(), |about| about.scenario.clone());
        Self { scenario, size, planner, version }
    }

    /// The width of all names, columns.
    fn width(&self) -> usize {
        [&self.scenario, &self.size, &self.planner, &self.version].map(|name| text::width(name)).iter().sum()
    }
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
        Phase::Running(Gait::Back) => ("OPER", Role::Run, "▶ BACK"),
        Phase::Held(_) if model.live.run.is_live() => ("LIVE", held_role(model), held_word(model)),
        // The operator is in control if only an order can move the robot, whatever has held it.
        Phase::Held(hold) if hold.resumes.is_never() => ("OPER", Role::Hold, "‖ HOLD"),
        Phase::Held(_) => ("AUTO", Role::Hold, "‖ HOLD"),
        Phase::Ended(Outcome::Complete) => ("OPER", Role::Good, "✓ DONE"),
        Phase::Ended(_) => ("OPER", Role::Warn, "■ ENDED"),
    };
    let (role, word) = if model.live.is_cut_off { (Role::Crit, "■ CUT OFF") } else { (role, word) };
    let who = if model.live.run.is_live() { "LIVE" } else { who };
    let who = if model.live.is_look_only() { "VIEW" } else { who };
    vec![(Role::Title, format!("{who} ")), (role, word.into())]
}

/// Whether a held vehicle really stands still.
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
        return vec![clock, (Role::Text, text::speed(model.live.speed))];
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

/// The number of open alarms of each severity, marked if any of them are unacknowledged.
pub(super) fn alarms(model: &Model, long: bool) -> Parts {
    let alarms = &model.live.run.alarms;
    if alarms.open().next().is_none() {
        return vec![(Role::Dim, "no alarm".into())];
    }
    let counted = [
        (Severity::Crit, Role::Crit, "crit", "C"),
        (Severity::Warn, Role::Warn, "warn", "W"),
        (Severity::Watch, Role::Watch, "watch", "w"),
    ];
    let mut parts = vec![(Role::Title, if long { "ALARM".into() } else { "!".into() })];
    for (severity, role, word, letter) in counted {
        let count = alarms.count(severity);
        let words = match (long, alarms.unacknowledged(severity)) {
            (true, 0) => format!("{count} {word}"),
            (true, open) => format!("{count} {word} ({open} unacknowledged)"),
            (false, 0) => format!("{count}{letter}"),
            (false, _) => format!("{count}{letter}*"),
        };
        if count > 0 {
            parts.extend([(Role::Text, " ".into()), (role, words)]);
        }
    }
    parts
}
