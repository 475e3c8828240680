//! How the console itself does, and the limits of it.

use super::alarms::limit::{Limit, Watch};
use serde::{Deserialize, Serialize};

/// Time from a key to its frame, milliseconds: one frame of a screen at 30 Hz. It is back when a third of that is to spare;
/// the delays leave out a single slow frame.
pub const RESPONSE_MS: Limit = Limit { alarm: 33.0, clear: 22.0, on_delay_s: 2.0, off_delay_s: 5.0 };
/// Frames skipped within ten seconds, of about 300: from one in ten on the screen stutters. The figure spans ten seconds, so
/// that it needs no delay to come.
pub const FRAMES: Limit = Limit { alarm: 30.0, clear: 10.0, on_delay_s: 0.0, off_delay_s: 5.0 };
/// Ticks that wait to be written, of 8192 that can: at half of them the simulation waits for the disk, so that this leaves
/// time to act. A disk that pauses for a second is not an alarm.
pub const RECORDER_LAG: Limit = Limit { alarm: 1024.0, clear: 128.0, on_delay_s: 1.0, off_delay_s: 2.0 };
/// Space left where runs are kept, megabytes: a mission takes about 100 MB an hour, so that two hours are left. Space that
/// is freed for a moment does not count.
pub const DISK_MB: Limit = Limit { alarm: 200.0, clear: 300.0, on_delay_s: 0.0, off_delay_s: 5.0 };

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

/// How the engine of a run does.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Health {
    /// Whether the run is being written down.
    pub recording: Recording,
    /// The speed that is really reached, as a multiple of the wall clock; `None` when not measured.
    pub reached_speed: Option<f64>,
    /// Ticks whose events wait to be written.
    #[serde(default)]
    pub recorder_lag: u64,
}

/// What the console measures of itself.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Measured {
    /// How the screen did.
    Screen {
        /// Time from a key to its frame that one key in a hundred exceeds, milliseconds; `None` without recent keys.
        response_ms: Option<f64>,
        /// Frames that were skipped in the last ten seconds.
        skipped: u32,
    },
    /// Space left where runs are kept, bytes.
    Disk(u64),
}

/// The figures that are compared with their limits.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Watches {
    /// Time from a key to its frame.
    pub response: Watch,
    /// Frames skipped.
    pub frames: Watch,
    /// Recorder behind the mission.
    pub recorder_lag: Watch,
    /// Space left.
    pub disk: Watch,
}

impl Watches {
    /// Whether a figure of the screen has to be measured again even if nothing happens.
    pub(super) fn is_pending(&self) -> bool {
        self.response.is_pending() || self.frames.is_pending()
    }
}
