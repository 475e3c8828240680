//! Everything the screen knows, as plain data.

pub mod alarms;
pub mod coverage;
pub mod fold;
pub mod log;
pub mod parameter;
pub mod position;
pub mod tether;
pub mod trail;
pub mod ui;

pub use alarms::{Alarm, Alarms, Cause};
pub use coverage::Raster;
pub use log::{Entry, Log};
pub use position::Position;
pub use tether::Tether;
pub use trail::Trail;
pub use ui::{Overlay, Pane, Ui};

use mission::{
    FoldedStanding, MissionConfig, Order, Phase, PlannerChoice, PlannerInfo, Severity, TaskConfig, WorkerId,
    planner::Fault,
};
use planner_api::{Command, Drawing};
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

/// A plan, thinned out for drawing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanShown {
    /// Points of the path.
    pub path: Vec<Point>,
    /// Length of the whole path, metres.
    pub length_m: f64,
    /// Whether it achieves the whole task.
    pub complete: bool,
    /// Mission time at which it was made, seconds.
    pub t_s: f64,
}

/// The planner and what it last did.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Planning {
    /// The active planner, with the parameters set by hand.
    pub choice: Option<PlannerChoice>,
    /// Who it is.
    pub info: Option<PlannerInfo>,
    /// Its plan.
    pub plan: Option<PlanShown>,
    /// Its last command, with the mission time of it, seconds.
    pub command: Option<(f64, Command)>,
    /// Its last drawings.
    pub drawings: Vec<Drawing>,
    /// The tick of these.
    pub drawings_tick: u64,
    /// Its last figures: name, value, unit.
    pub scalars: Vec<(String, f64, String)>,
    /// Its last failure, until it is active again.
    pub fault: Option<Fault>,
    /// The worker of a planner that is being prepared; its plans are not flown yet.
    #[serde(default)]
    pub candidate: Option<WorkerId>,
    /// Whether the last plan was of that planner: the certificate that follows says nothing of the plan that is flown.
    #[serde(default)]
    pub proposed: bool,
}

/// The time, by the caller.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Times {
    /// Seconds on a clock that never jumps.
    pub mono_s: f64,
    /// Seconds since 1970, UTC.
    pub wall_unix_s: f64,
}

/// How fast a simulated mission goes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Speed {
    /// So many times as fast as the clock on the wall.
    Times(f64),
    /// As fast as it goes.
    Max,
}

impl Speed {
    /// Every speed the operator can choose, slowest first.
    pub const STEPS: [Self; 10] = [
        Self::Times(0.25),
        Self::Times(0.5),
        Self::Times(1.0),
        Self::Times(2.0),
        Self::Times(4.0),
        Self::Times(8.0),
        Self::Times(16.0),
        Self::Times(32.0),
        Self::Times(64.0),
        Self::Max,
    ];

    /// The next speed up or down, if there is one.
    pub fn stepped(self, faster: bool) -> Option<Self> {
        let at = Self::STEPS.iter().position(|step| *step == self).unwrap_or(2);
        let next = if faster { at.checked_add(1) } else { at.checked_sub(1) };
        next.and_then(|index| Self::STEPS.get(index)).copied()
    }
}

impl Default for Speed {
    fn default() -> Self {
        Self::Times(1.0)
    }
}

/// Whether the run is being written down.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Recording {
    /// Nobody asked for it.
    #[default]
    Off,
    /// Everything is being written.
    On,
    /// It failed, and why.
    Failed(String),
}

/// How the console itself does.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Health {
    /// Whether the run is being written down.
    pub recording: Recording,
    /// The speed that is really reached, as a multiple of the wall clock; `None` when not measured.
    pub reached_speed: Option<f64>,
}

/// A plugin that was found and not accepted.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Refused {
    /// File name of the plugin, without the folder.
    pub plugin: String,
    /// Why, as a sentence.
    pub reason: String,
}

/// A message for the operator that disappears by itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Notice {
    /// How much it asks of the operator.
    pub severity: Severity,
    /// What, as a sentence.
    pub text: String,
    /// When it goes, on the console's own clock, seconds.
    pub until_mono_s: f64,
}

/// A planner's work that takes time; ticks and HOLD continue meanwhile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Busy {
    /// What it is, such as `Planning (rpf)`.
    pub work: String,
    /// How long it may take, seconds; not known for what is short.
    pub limit_s: Option<f64>,
    /// When it began, on the console's own clock, seconds.
    pub since_mono_s: f64,
    /// How far it is: the share done, 0 to 1, and what is being done; `None` if it is not reported.
    #[serde(default)]
    pub at: Option<(f64, String)>,
}

/// The console itself.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Console {
    /// The time, by the last message.
    pub now: Times,
    /// How fast the mission shall go.
    pub speed: Speed,
    /// How the console does.
    pub health: Health,
    /// Planners to choose from.
    pub planners: Vec<PlannerInfo>,
    /// Plugins that cannot be chosen.
    pub refused: Vec<Refused>,
    /// What a planner is working on.
    pub busy: Option<Busy>,
    /// What was last said to the operator.
    pub notice: Option<Notice>,
    /// An order that makes the robot move and was not answered yet.
    pub asked: Option<Order>,
    /// Whether HOLD was sent and not answered yet.
    pub hold_asked: bool,
    /// When Ctrl-C was last pressed, on the console's own clock, seconds.
    pub interrupted_mono_s: Option<f64>,
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
