//! Everything the screen knows, as plain data.

pub mod alarms;
pub mod console;
pub mod coverage;
pub mod fold;
pub mod log;
pub mod parameter;
pub mod planning;
pub mod position;
pub mod tether;
pub mod trail;
pub mod ui;

pub use alarms::{Alarm, Alarms, Cause};
pub use console::{Busy, Console, Health, Notice, Recording, Refused, Speed, Times};
pub use coverage::Raster;
pub use log::{Entry, Log};
pub use planning::{PlanShown, Planning};
pub use position::Position;
pub use tether::Tether;
pub use trail::Trail;
pub use ui::{Overlay, Pane, Ui};

use mission::{FoldedStanding, MissionConfig, Phase, PlannerInfo, Severity, TaskConfig};
use positioning::AccuracyMap;
use serde::{Deserialize, Serialize};
use world::{Point, World};

/// Seconds for which a refusal or a piece of news stays in the line above the keys.
const NOTICE_S: f64 = 8.0;
/// Seconds without any event after which a running mission counts as silent.
const SILENCE_S: f64 = 2.0;

/// Everything the screen knows.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Model {
    /// What the run is about; `None` until it is opened.
    pub run: Option<Run>,
    /// What the mission is doing, and which orders it accepts.
    pub standing: FoldedStanding,
    /// Why it ended, as a sentence; empty before.
    pub end_reason: String,
    /// Mission time.
    pub clock: Clock,
    /// Where the robot believes to be, and how well it knows.
    pub position: Position,
    /// Where it has been.
    pub trail: Trail,
    /// What has been scanned.
    pub coverage: Option<Raster>,
    /// How well the stations are forecast to locate the robot.
    pub accuracy: Option<AccuracyMap>,
    /// How far the mission is; `None` before the first step.
    pub progress: Option<Progress>,
    /// The tether; `None` without one.
    #[serde(default)]
    pub tether: Option<Tether>,
    /// The planner and what it last did.
    pub planning: Planning,
    /// What is wrong.
    pub alarms: Alarms,
    /// What happened.
    pub log: Log,
    /// The console itself.
    pub console: Console,
    /// What the operator looks at.
    pub ui: Ui,
}

/// What a run is about.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Name of the scenario.
    pub scenario: String,
    /// Start of every random choice.
    pub seed: u64,
    /// The tank as the mission knows it: the drawing, and what was found since.
    pub world: World,
    /// The mission.
    pub mission: MissionConfig,
    /// Length of the preset path, metres; `None` for a mission without one.
    pub preset_m: Option<f64>,
}

/// Mission time, by the events.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Clock {
    /// Number of the last tick.
    pub tick: u64,
    /// Mission time at its top, seconds.
    pub t_s: f64,
    /// Mission time spent under way and not held, seconds.
    pub moving_s: f64,
    /// When the last events arrived, on the console's own clock, seconds.
    pub heard_mono_s: f64,
}

/// How far the mission is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// Share of the task done, 0 to 1.
    pub done: f64,
    /// Way along the preset path, metres.
    pub along_m: Option<f64>,
    /// Distance from the preset path, metres.
    pub cross_track_m: Option<f64>,
    /// Where the robot goes next.
    pub target: Point,
    /// Scanned share of the reachable floor, 0 to 1.
    pub covered_reachable: f64,
    /// Scanned share of the whole floor, 0 to 1.
    pub covered_whole: f64,
}

impl Model {
    /// What the mission is doing.
    pub fn phase(&self) -> &Phase {
        &self.standing.phase
    }

    /// Whether the mission runs: the robot moves, or waits for its planner.
    pub fn is_running(&self) -> bool {
        matches!(self.phase(), Phase::Running(_))
    }

    /// Whether the robot moves, or may begin to move without an order, or because of one that was sent and not answered yet.
    pub fn may_move(&self) -> bool {
        self.phase().may_move() || self.console.asked.is_some()
    }

    /// Why a planner cannot fly this mission, if it cannot.
    pub fn cannot_fly(&self, planner: &PlannerInfo) -> Option<&'static str> {
        let covers =
            self.run.as_ref().is_some_and(|run| matches!(run.mission.task, TaskConfig::Cover { .. }));
        if covers { planner.why_no_coverage() } else { None }
    }

    /// What is known of the active planner, or of the first one.
    pub fn planner(&self) -> Option<&PlannerInfo> {
        let id = self.planner_id();
        let listed = || self.console.planners.iter().find(|planner| Some(planner.id.as_str()) == id);
        self.planning.info.as_ref().or_else(listed)
    }

    /// Id of the active planner, or of the first one.
    pub fn planner_id(&self) -> Option<&str> {
        self.planning.choice.as_ref().map(|choice| choice.id.as_str())
    }

    /// Whether leaving would abort a mission: one that was started and has not ended, or whose start was requested.
    pub fn is_under_way(&self) -> bool {
        !self.has_ended() && (*self.phase() != Phase::Waiting || self.may_move())
    }

    /// Whether the run is over.
    pub fn has_ended(&self) -> bool {
        matches!(self.phase(), Phase::Ended(_))
    }

    /// Whether the mission runs and yet nothing was heard of it, and for how long, seconds.
    pub fn silent_s(&self) -> Option<f64> {
        let silence_s = self.console.now.mono_s - self.clock.heard_mono_s;
        (self.is_running() && silence_s > SILENCE_S).then_some(silence_s)
    }

    /// The notice, while it is fresh.
    pub fn notice(&self) -> Option<&Notice> {
        self.console.notice.as_ref().filter(|notice| notice.until_mono_s > self.console.now.mono_s)
    }

    /// When the screen next changes by itself, on the console's own clock, seconds; `None` if it does not.
    pub fn wakes_at_mono_s(&self) -> Option<f64> {
        let notice = self.notice().map(|notice| notice.until_mono_s);
        let silence = self.is_running().then(|| match self.silent_s() {
            None => self.clock.heard_mono_s + SILENCE_S,
            Some(_) => self.console.now.mono_s + 1.0,
        });
        // What takes long shows how long it has taken, second by second.
        let busy = self.console.busy.as_ref().map(|_| self.console.now.mono_s + 1.0);
        notice.into_iter().chain(silence).chain(busy).reduce(f64::min)
    }

    /// Mission time still to go at the pace so far, seconds.
    pub fn left_s(&self) -> Option<f64> {
        let done = self.progress.as_ref()?.done;
        let known = self.clock.moving_s > 10.0 && done > 0.01 && done <= 1.0 && !self.has_ended();
        known.then(|| self.clock.moving_s * (1.0 - done) / done)
    }

    /// Shows the operator a message in the line above the keys.
    pub(crate) fn say(&mut self, severity: Severity, text: impl Into<String>) {
        self.say_for(NOTICE_S, severity, text);
    }

    /// Shows the operator a message that is true for so many seconds only.
    pub(crate) fn say_for(&mut self, seconds: f64, severity: Severity, text: impl Into<String>) {
        let until_mono_s = self.console.now.mono_s + seconds;
        self.console.notice = Some(Notice { severity, text: text.into(), until_mono_s });
    }
}
