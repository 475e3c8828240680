//! The console itself: time, speeds, plugins, and its notices to the operator.

use super::{Overlay, Preset, Watches};
use crate::actions::keymap::Keymap;
use crate::keys::Key;
use mission::{PlannerInfo, RefusedPlugin, Severity};
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

impl Speed {
    /// Least multiple of the clock that the operator can choose.
    pub const SLOWEST: f64 = 0.25;
    /// Greatest one.
    pub const FASTEST: f64 = 64.0;

    /// Whether the mission goes faster than the clock on the wall.
    pub fn is_fast(self) -> bool {
        match self {
            Self::Times(factor) => factor > 1.0,
            Self::Max => true,
        }
    }

    /// Reads a speed, such as `8`, `x0.5` or `max`.
    ///
    /// # Errors
    /// What it may be.
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

    /// Twice or half as fast, if there is such a speed.
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

/// A key that is held down, or was pressed again; if no other press follows, it was pressed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settling {
    /// Which key.
    pub key: Key,
    /// What was over the screen: the press is meant for that and for nothing else.
    pub over: Overlay,
    /// When it is known, on the console's own clock, seconds.
    pub until_mono_s: f64,
}

/// Which new alarms ring the terminal's bell: from this severity on, or none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bell(pub Option<Severity>);

impl Default for Bell {
    fn default() -> Self {
        Self(Some(Severity::Crit))
    }
}

/// What the operator has set up.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Preferences {
    /// Who operates.
    pub operator: Option<String>,
    /// Whether the mouse is used.
    pub mouse: bool,
    /// Which new alarms ring the bell.
    pub bell: Bell,
    /// Longest time for which an alarm may be shelved, minutes.
    pub shelve_max_min: u32,
}

impl Default for Preferences {
    fn default() -> Self {
        Self { operator: None, mouse: false, bell: Bell::default(), shelve_max_min: 60 }
    }
}

/// The console itself.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Console {
    /// The time, by the last message.
    pub now: Times,
    /// Planners to choose from.
    pub planners: Vec<PlannerInfo>,
    /// Plugins that cannot be chosen.
    pub refused: Vec<RefusedPlugin>,
    /// What the last look at the plugins changed, as sentences; `None` before the second look.
    #[serde(default)]
    pub reloaded: Option<Vec<String>>,
    /// What was last said to the operator.
    pub notice: Option<Notice>,
    /// Which keys run which actions.
    pub keys: Keymap,
    /// Parameters under names.
    #[serde(default)]
    pub presets: Vec<Preset>,
    /// The last command lines, the newest last.
    pub history: Vec<String>,
    /// What the operator has set up.
    pub preferences: Preferences,
    /// Figures of the console and their limits.
    #[serde(default)]
    pub watches: Watches,
    /// A key that may be held down: what it does waits until that is known.
    #[serde(default)]
    pub settling: Option<Settling>,
    /// When Ctrl-C was last pressed, on the console's own clock, seconds.
    pub interrupted_mono_s: Option<f64>,
}
