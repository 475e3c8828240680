//! The console itself: time, speed, recording, and what is between the operator and the mission.

use mission::{Order, PlannerInfo, Severity};
use serde::{Deserialize, Serialize};

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

/// Slowest and fastest multiple of the clock that the operator can choose.
const SLOWEST: f64 = 0.25;
const FASTEST: f64 = 64.0;

impl Speed {
    /// Twice or half as fast, if there is such a speed.
    pub fn stepped(self, faster: bool) -> Option<Self> {
        match (self, faster) {
            (Self::Times(factor), true) if factor < FASTEST => Some(Self::Times(2.0 * factor)),
            (Self::Times(_), true) => Some(Self::Max),
            (Self::Times(factor), false) => (factor > SLOWEST).then_some(Self::Times(factor / 2.0)),
            (Self::Max, true) => None,
            (Self::Max, false) => Some(Self::Times(FASTEST)),
        }
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
