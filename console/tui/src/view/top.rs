//! The top line: who is in control, what is running, whether it is being recorded, and the alarms.

use super::look::{Look, Parts};
use super::text;
use crate::model::{Model, Recording, alarms::State, ui::Arrangement};
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
    let names = Names::of(model);
    let sum = |parts: &Parts| parts.iter().map(|(_, text)| text::width(text)).sum::<usize>();
    let room = |[state, time, alarms]: &[Parts; 3]| {
        let fixed = 1 + 3 * gap.len() + sum(state) + sum(time) + sum(alarms);
        usize::from(area.width).saturating_sub(fixed)
    };
    // The name of the scenario is shortened last.
    let long = [state(model), time(model), alarms(model, Counts::Long)];
    let long = Some(long).filter(|parts| area.width >= LONG_ALARMS && names.width() <= room(parts));
    let others = long.unwrap_or_else(|| beside(model, |parts| text::width(&names.scenario) <= room(parts)));
    let room = room(&others);
    let [state, time, alarms] = others;
    let scenario = text::fit(&names.scenario, room);
    let mut room = room - text::width(&scenario);
    // An item that does not fit beside the scenario is left out completely.
    let mut fits = |columns: usize| {
        let fits = columns <= room;
        room -= if fits { columns } else { 0 };
        fits
    };
    let mut planner = names.planner.clone();
    if !planner.is_empty() {
        planner.insert_str(0, gap);
    }
    if !fits(text::width(&planner)) {
        planner.clear();
    }
    let has_version = wide && !planner.is_empty() && fits(text::width(&names.version));
    let has_size = wide && fits(text::width(&names.size));
    let blank = || vec![(Role::Text, gap.to_owned())];
    let named = vec![
        (Role::Text, if has_size { scenario + &names.size } else { scenario }),
        (Role::Title, if has_version { planner + &names.version } else { planner }),
    ];
    let line =
        [vec![(Role::Text, " ".into())], state, blank(), named, blank(), time, blank(), alarms].concat();
    frame.render_widget(look.line(line), area);
}

/// State, time and alarms in the longest forms that leave room for the name of the scenario; in the shortest ones if none
/// does.
fn beside(model: &Model, fits: impl Fn(&[Parts; 3]) -> bool) -> [Parts; 3] {
    let full = |counts| [state(model), time(model), alarms(model, counts)];
    let briefly = || [state(model), brief(time(model)), alarms(model, Counts::Letters)];
    let least = || [state(model).split_off(1), brief(time(model)), alarms(model, Counts::Letters)];
    let forms = [Counts::Short, Counts::Worst, Counts::Letters].map(full);
    forms.into_iter().chain([briefly()]).find(fits).unwrap_or_else(least)
}

/// The time with a mark instead of the words for a saved recording.
fn brief(mut time: Parts) -> Parts {
    for (_, text) in &mut time {
        *text = text.replace(SAVED, "REC✓");
    }
    time
}

/// A recording that is complete.
const SAVED: &str = "REC saved";

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
        Phase::Running(Gait::Back) => ("AUTO", Role::Run, "▶ BACK"),
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
        _ if model.live.result.as_ref().is_some_and(|result| result.is_kept) => (Role::Good, SAVED.into()),
        Recording::On => (Role::Good, "REC●".into()),
        Recording::Off => (Role::Dim, "REC-".into()),
        Recording::Failed(_) => (Role::Crit, "REC✗".into()),
    }
}

/// How the open alarms are written in the top line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Counts {
    /// The number of each severity, and how many of them are unacknowledged.
    Long,
    /// The number of each severity, and whether any alarm is unacknowledged.
    Short,
    /// The number of the most severe ones and of all others.
    Worst,
    /// The same with a letter for the severity, and a star if any alarm is unacknowledged: `2C* +1`.
    Letters,
}

/// The open alarms.
pub(super) fn alarms(model: &Model, counts: Counts) -> Parts {
    let alarms = &model.live.run.alarms;
    if alarms.open().next().is_none() {
        let shelved = alarms.list().iter().filter(|alarm| matches!(alarm.state, State::Shelved(_))).count();
        let words = if shelved > 0 { format!("{shelved} shelved") } else { "no alarm".into() };
        return vec![(Role::Dim, words)];
    }
    let severities = [
        (Severity::Crit, Role::Crit, "crit"),
        (Severity::Warn, Role::Warn, "warn"),
        (Severity::Watch, Role::Watch, "watch"),
    ];
    let open = severities.into_iter().filter(|(severity, ..)| alarms.count(*severity) > 0);
    let is_brief = matches!(counts, Counts::Worst | Counts::Letters);
    let most = if is_brief { 1 } else { severities.len() };
    let mut parts: Parts = if counts == Counts::Long { vec![(Role::Title, "ALARM ".into())] } else { vec![] };
    for (severity, role, word) in open.clone().take(most) {
        let words = match alarms.unacknowledged(severity) {
            new if new > 0 && counts == Counts::Long => {
                format!("{} {word} ({new} unacknowledged)", alarms.count(severity))
            }
            new if counts == Counts::Letters => {
                let letter = if severity == Severity::Watch { "w".into() } else { word[..1].to_uppercase() };
                format!("{}{letter}{}", alarms.count(severity), if new > 0 { "*" } else { "" })
            }
            _ => format!("{} {word}", alarms.count(severity)),
        };
        parts.extend([(role, words), (Role::Text, " ".into())]);
    }
    let others: usize = open.clone().skip(most).map(|(severity, ..)| alarms.count(severity)).sum();
    if others > 0 {
        parts.push((Role::Text, format!("+{others} ")));
    }
    let is_new = open.clone().any(|(severity, ..)| alarms.unacknowledged(severity) > 0);
    if is_new && !matches!(counts, Counts::Long | Counts::Letters) {
        parts.push((Role::Title, "unack ".into()));
    }
    if let Some((_, last)) = parts.last_mut() {
        last.truncate(last.trim_end().len());
    }
    parts.retain(|(_, text)| !text.is_empty());
    parts
}
