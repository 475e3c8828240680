//! The console as sentences, one per line, for screen readers and logs.

use crate::actions::{Action, ActionId, Topic, find};
use crate::model::{
    Alarm, Entry, Model, Overlay, Recording, Screen,
    log::{clock, severity_word},
    what_if::{Candidate, Forecast},
};
use crate::update::offered;
use crate::view::text;
use crate::view::{Bases, by_command, question, standing};
use mission::{EventKind, Outcome, Severity};
use world::coverage::percent;

/// What has been printed so far.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Said {
    screen: Option<Screen>,
    /// The number of the next log line to print.
    next_line: u64,
    notice: Option<String>,
    question: Option<String>,
    standing: Vec<String>,
    tenths: u8,
    /// How many forecasts of the open what-if have been printed.
    forecasts: usize,
}

impl Said {
    /// The changes since the last call, one sentence each.
    pub fn next(&mut self, model: &Model) -> Vec<String> {
        let screen = model.ui.screen;
        let mut lines = Vec::new();
        if self.screen.replace(screen) != Some(screen) {
            lines.push(format!("Screen {}: {}.", screen.digit(), screen.name()));
        }
        // The sentence about the state already says that the robot is held; in a live run, it does so only once the
        // stop is confirmed.
        let is_hold = |entry: &Entry| matches!(entry.what.event(), Some(of) if matches!(of.kind, EventKind::Held { .. }));
        // Planners' messages about their own work are hidden on the screen, too, until the operator asks for them.
        let least =
            if model.ui.events.matches.filter().shows_debug() { Severity::Debug } else { Severity::Info };
        let is_said = |entry: &Entry| entry.severity >= least && !is_hold(entry);
        let entries: Vec<Entry> = self.entries(model).into_iter().filter(is_said).collect();
        lines.extend(entries.iter().map(Entry::line));
        let notice = model.notice().map(|notice| notice.text.clone());
        let is_said = |text: &String| entries.iter().any(|entry| entry.text == *text);
        lines.extend(newly(&mut self.notice, notice).filter(|text| !is_said(text)));
        lines.extend(newly(&mut self.question, question(model)));
        let standing = standing(model);
        if standing != self.standing {
            // Of a state that continues, only the sentences that have changed are printed.
            let same = standing.iter().zip(&self.standing).take_while(|(now, before)| now == before).count();
            let new = standing[same..].join(" ");
            // A log line that has just been printed may begin the sentence about the state.
            let said = entries.iter().find_map(|entry| new.strip_prefix(&format!("{}. ", entry.text)));
            lines.extend(Some(said.unwrap_or(&new).to_owned()).filter(|new| !new.is_empty()));
            self.standing = standing;
        }
        lines.extend(self.coverage(model));
        lines.extend(self.forecasts(model));
        lines
    }

    /// The forecasts finished since the last call, in the order of the what-if table.
    fn forecasts(&mut self, model: &Model) -> Vec<String> {
        let candidates = model.live.what_if.as_ref().map_or(&[][..], |what_if| &what_if.candidates);
        let made: Vec<String> = candidates.iter().map_while(forecast).collect();
        let known = std::mem::replace(&mut self.forecasts, made.len());
        made.into_iter().skip(known).collect()
    }

    /// The log lines added since the last call, oldest first.
    fn entries(&mut self, model: &Model) -> Vec<Entry> {
        let log = &model.live.run.log;
        // A new run begins with a new log.
        let from = match log.end() < self.next_line {
            // When a replay passes the same lines again, they have already been printed.
            true if model.live.is_replay() => log.end(),
            true => 0,
            false => self.next_line,
        };
        self.next_line = log.end();
        (from.max(log.oldest())..log.end()).filter_map(|number| log.get(number)).cloned().collect()
    }

    /// Reports each further tenth of the floor that has been scanned.
    fn coverage(&mut self, model: &Model) -> Option<String> {
        let scanned = model.live.run.progress.as_ref()?.covered_reachable;
        let tenths = (10.0 * scanned).floor().clamp(0.0, 10.0) as u8;
        let is_more = tenths > self.tenths;
        self.tenths = tenths;
        is_more.then(|| format!("{} % of reachable floor scanned.", 10 * u32::from(tenths)))
    }
}

/// The answer to `status`: state, time, position, tether, floor, recording, open alarms and the open question, one sentence each.
pub fn status(model: &Model) -> Vec<String> {
    let run = &model.live.run;
    let scenario = run.about.as_ref().map_or("no mission", |about| about.scenario.as_str());
    let planner = run.planner_id().unwrap_or("unknown");
    let speed = text::speed(model.live.speed);
    let mut lines = vec![
        by_command(model).join(" "),
        format!("{scenario}, planner {planner}, T+{}, speed {speed}.", clock(run.clock.t_s)),
    ];
    lines.extend(position(model));
    lines.extend(tether(model));
    let bases = Bases::of(&model.live);
    let ([first, second], [floor, other]) = (bases.scanned(), bases.floors);
    if run.coverage.is_some() && run.progress.is_some() {
        lines.push(format!("Scanned: {first} % of {floor}, {second} % of {other}."));
    }
    lines.push(match (&model.live.result, &model.live.health.recording) {
        (Some(result), _) => format!("{}.", text::capitalized(&result.kept)),
        (None, Recording::On) => "Recording is on.".into(),
        (None, Recording::Off) => "Nothing is being recorded.".into(),
        (None, Recording::Failed(why)) => format!("RECORDING FAILED: {why}."),
    });
    let alarms: Vec<&Alarm> = run.alarms.table().into_iter().filter(|alarm| alarm.is_open()).collect();
    lines.push(if alarms.is_empty() {
        "No alarms.".into()
    } else {
        format!("Open alarms: {}.", alarms.len())
    });
    lines.extend(alarms.iter().map(|alarm| {
        let unacknowledged = if alarm.is_unacknowledged() { ", not acknowledged" } else { "" };
        format!("{}{unacknowledged}: {}.", severity_word(alarm.severity), alarm.text)
    }));
    lines.extend(question(model));
    lines
}

/// The estimated position and its error, as a sentence; `None` until it is known.
fn position(model: &Model) -> Option<String> {
    let position = &model.live.run.position;
    let pose = position.pose.as_ref()?;
    let lost = if position.lost { " LOST" } else { "" };
    let error = position.error_m().map_or_else(|| "unknown".into(), |error_m| format!("±{error_m:.2} m"));
    let heading = text::number(pose.heading_rad.to_degrees().rem_euclid(360.0), 0);
    Some(format!("Position{lost}: {}, heading {heading}°, 95 % error {error}.", text::place(pose.position)))
}

/// The tether paid out and its largest wrap, as a sentence; `None` without a tether.
fn tether(model: &Model) -> Option<String> {
    let run = &model.live.run;
    let tether = run.tether.as_ref().filter(|tether| tether.t_s.is_some())?;
    let reel_m = run.about.as_ref()?.mission.tether.as_ref()?.limits.reel_length_m;
    let wrap = tether.largest().map_or_else(String::new, |contact| {
        format!(", largest wrap {:.0}° on {}", contact.wrap_rad.abs().to_degrees(), contact.on)
    });
    let trouble = tether.trouble();
    Some(format!("Tether{trouble}: {:.1} of {reel_m:.1} m out{wrap}.", tether.length_m))
}

/// Whether an action changes only a picture or opens a list; sentences have neither.
fn is_only_drawn(action: &Action) -> bool {
    use ActionId::{
        Commands, Copy, Help, Messages, NextLike, NextMissed, NextPane, PreviousLike, PreviousMissed,
        PreviousPane, ShowPlace, Theme,
    };
    let of_screen = matches!(
        action.id,
        Commands
            | Copy
            | Help
            | Messages
            | NextLike
            | NextMissed
            | NextPane
            | PreviousLike
            | PreviousMissed
            | PreviousPane
            | ShowPlace
            | Theme
    );
    of_screen || action.topic == Topic::Map
}

/// The answer to `help`: the commands that can be given now and have an effect on sentences, one per line, and how to
/// learn more.
pub fn help(model: &Model) -> Vec<String> {
    let is_listed = |action: &&Action| !is_only_drawn(action) && offered(model, action.id).is_ok();
    let now = find::commands().filter(is_listed);
    let mut keys = model.console.keys.clone();
    keys.spells_commands = true;
    let line = |action: &'static Action| format!("{}: {}.", action.usage(), keys.spelled(action.about));
    let rest = ["status: Print the state.", "yes, no: Answer a question.", "key NAME: Press a key."];
    now.map(line).chain(rest.map(str::to_owned)).collect()
}

/// The answer to `yes` and `no` if no question is open.
pub fn no_question(model: &Model) -> Option<&'static str> {
    (model.ui.overlay == Overlay::None).then_some("No question is open: `yes` and `no` have no effect.")
}

/// The forecast for a planner, if it is finished.
fn forecast(candidate: &Candidate) -> Option<String> {
    let planner = &candidate.choice.id;
    Some(match candidate.made.as_ref()? {
        Err(why) => format!("What-if {planner}: {why}."),
        Ok(Forecast { outlook, .. }) => {
            let end = outlook.outcome.map_or("held", Outcome::word);
            format!(
                "What-if {planner}: {end} after {}, {:.1} m, {:.1} % of reachable floor, clearance {:.2} m: {}.",
                clock(outlook.after_s),
                outlook.length_m,
                percent(outlook.reachable),
                outlook.clearance_min_m,
                outlook.reason
            )
        }
    })
}

/// Remembers the current text; returns it if it is new.
fn newly(last: &mut Option<String>, now: Option<String>) -> impl Iterator<Item = String> + use<> {
    let is_new = *last != now;
    last.clone_from(&now);
    now.filter(|_| is_new).into_iter()
}
