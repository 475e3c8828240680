//! The console itself: time, speed, plugins, and notices to the operator.

use super::{Overlay, Preset, Watches};
use crate::actions::keymap::Keymap;
use crate::keys::Key;
use mission::{PlannerInfo, RefusedPlugin, Severity};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The maximum number of messages that are remembered.
const MAX_MESSAGES: usize = 200;

/// The current time, set by the caller.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Times {
    /// Monotonic time, seconds.
    pub mono_s: f64,
    /// Seconds since 1970, UTC.
    pub wall_unix_s: f64,
}

/// The speed of a simulated mission.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Speed {
    /// A multiple of wall-clock time.
    Times(f64),
    /// As fast as possible.
    Max,
}

impl Speed {
    /// The lowest multiple that the operator can choose.
    pub const SLOWEST: f64 = 0.25;
    /// The highest multiple that the operator can choose.
    pub const FASTEST: f64 = 64.0;

    /// Whether the mission runs faster than the wall clock.
    pub fn is_fast(self) -> bool {
        match self {
            Self::Times(factor) => factor > 1.0,
            Self::Max => true,
        }
    }

    /// Parses a speed, such as `8`, `x0.5` or `max`.
    ///
    /// # Errors
    /// Returns a message that states which values are permitted.
    pub fn parse(text: &str) -> Result<Self, String> {
        let wrong = || format!("must be {} to {}, or max", Self::SLOWEST, Self::FASTEST);
        match text.trim_start_matches(['x', '×']) {
            "max" => Ok(Self::Max),
            number => match number.parse::<f64>() {
                Ok(factor) if (Self::SLOWEST..=Self::FASTEST).contains(&factor) => Ok(Self::Times(factor)),
                _ => Err(wrong()),
            },
        }
    }

    /// Twice or half the speed; `None` if that is out of range.
    pub fn stepped(self, faster: bool) -> Option<Self> {
        match (self, faster) {
            (Self::Times(factor), true) if factor < Self::FASTEST => {
                Some(Self::Times((2.0 * factor).min(Self::FASTEST)))
            }
            (Self::Times(_), true) => Some(Self::Max),
            (Self::Times(factor), false) => {
                (factor > Self::SLOWEST).then(|| Self::Times((factor / 2.0).max(Self::SLOWEST)))
            }
            (Self::Max, true) => None,
            (Self::Max, false) => Some(Self::Times(Self::FASTEST)),
        }
    }
}

impl Default for Speed {
    fn default() -> Self {
        Self::Times(1.0)
    }
}

/// A message to the operator that disappears automatically.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Notice {
    /// The severity of the message.
    pub severity: Severity,
    /// The message, as a sentence.
    pub text: String,
    /// When the message disappears, on the console's own clock, seconds.
    pub until_mono_s: f64,
    /// Whether the message answers a key; the hold that an earlier key has caused does not remove it.
    #[serde(default)]
    pub is_answer: bool,
}

/// A message in the history of messages.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Message {
    /// The time of the run, seconds; `None` if no run was open.
    pub t_s: Option<f64>,
    /// The time of day, seconds since 1970, UTC.
    pub wall_unix_s: f64,
    /// The severity of the message.
    pub severity: Severity,
    /// The message, as a sentence.
    pub text: String,
}

/// A key that is either held down or pressed a second time. If no other press follows, it was a second press.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settling {
    /// The key.
    pub key: Key,
    /// The overlay that was open at the time; the press applies to that overlay only.
    pub over: Overlay,
    /// When it becomes clear whether the key is held down, on the console's own clock, seconds.
    pub until_mono_s: f64,
}

/// When the open question appeared.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Appeared {
    /// The time at which it was drawn or, until then, at which it was asked, on the console's own clock, seconds.
    pub at_mono_s: f64,
    /// The number of the first frame that shows it; `None` until it is drawn.
    pub frame: Option<u64>,
}

/// The lowest severity at which a new alarm rings the terminal's bell; `None` for no bell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bell(pub Option<Severity>);

impl Default for Bell {
    fn default() -> Self {
        Self(Some(Severity::Crit))
    }
}

/// The operator's preferences.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Preferences {
    /// The operator's name.
    pub operator: Option<String>,
    /// Whether the console uses the mouse.
    pub mouse: bool,
    /// Which new alarms ring the bell.
    pub bell: Bell,
    /// The longest time for which an alarm may be shelved, minutes.
    pub shelve_max_min: u32,
    /// Whether a better plan on offer slows a fast simulation to real time.
    #[serde(default)]
    pub slows_for_offers: bool,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            operator: None,
            mouse: false,
            bell: Bell::default(),
            shelve_max_min: 60,
            slows_for_offers: true,
        }
    }
}

/// The state of the console itself.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Console {
    /// The time of the latest message.
    pub now: Times,
    /// The planners to choose from.
    pub planners: Vec<PlannerInfo>,
    /// The refused plugins.
    pub refused: Vec<RefusedPlugin>,
    /// The changes found by the last rescan of the plugins, as sentences; `None` before the first rescan.
    #[serde(default)]
    pub reloaded: Option<Vec<String>>,
    /// The latest notice.
    pub notice: Option<Notice>,
    /// The latest messages, newest last.
    #[serde(default)]
    pub messages: VecDeque<Message>,
    /// The key assignments.
    pub keys: Keymap,
    /// The saved parameter presets.
    #[serde(default)]
    pub presets: Vec<Preset>,
    /// The latest command lines, newest last.
    pub history: Vec<String>,
    /// The operator's preferences.
    pub preferences: Preferences,
    /// The console's own figures that are compared with limits.
    #[serde(default)]
    pub watches: Watches,
    /// A key that may be held down; its action waits until it is known whether it is.
    #[serde(default)]
    pub settling: Option<Settling>,
    /// When the open question appeared; `None` if no question is open.
    #[serde(default)]
    pub appeared: Option<Appeared>,
    /// When Ctrl-C was last pressed, on the console's own clock, seconds.
    pub interrupted_mono_s: Option<f64>,
}

impl Console {
    /// Adds a message to the history; the oldest one is dropped when the history is full.
    pub(crate) fn remember(&mut self, message: Message) {
        let surplus = (self.messages.len() + 1).saturating_sub(MAX_MESSAGES);
        self.messages.drain(..surplus);
        self.messages.push_back(message);
    }
}
