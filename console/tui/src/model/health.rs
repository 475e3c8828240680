//! The health of the console itself, and its limits.

use super::alarms::limit::{Limit, Watch};
use serde::{Deserialize, Serialize};

/// A limit that depends on whether the robot may move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ByMotion {
    /// While the robot may move.
    pub moving: Limit,
    /// While it stands still: before the start, during a hold and after the end.
    pub standing: Limit,
}

impl ByMotion {
    /// The same limit in both cases.
    const fn same(limit: Limit) -> Self {
        Self { moving: limit, standing: limit }
    }

    /// The limit that applies.
    pub fn of(&self, may_move: bool) -> &Limit {
        if may_move { &self.moving } else { &self.standing }
    }
}

/// Time from a key press to its frame, milliseconds: one frame of a 30 Hz screen; while the robot stands still, a tenth
/// of a second, which people do not notice. The alarm clears when the time is a third below its limit. Because of the
/// delays, a single slow frame has no effect.
pub const RESPONSE_MS: ByMotion = ByMotion {
    moving: Limit { alarm: 33.0, clear: 22.0, on_delay_s: 2.0, off_delay_s: 5.0 },
    standing: Limit { alarm: 100.0, clear: 66.0, on_delay_s: 2.0, off_delay_s: 5.0 },
};
/// Frames skipped within ten seconds, out of about 300: if more than one in ten is skipped, the screen stutters. While
/// the robot stands still, little changes, and half of the frames may be skipped. The figure already spans ten seconds,
/// so the alarm needs no delay.
pub const FRAMES: ByMotion = ByMotion {
    moving: Limit { alarm: 30.0, clear: 10.0, on_delay_s: 0.0, off_delay_s: 5.0 },
    standing: Limit { alarm: 150.0, clear: 50.0, on_delay_s: 0.0, off_delay_s: 5.0 },
};
/// Ticks waiting to be written, in a queue of 8192. When the queue is half full, the simulation waits for the disk,
/// so this limit leaves time to act. A disk that pauses for a second raises no alarm.
pub const RECORDER_LAG: ByMotion =
    ByMotion::same(Limit { alarm: 1024.0, clear: 128.0, on_delay_s: 1.0, off_delay_s: 2.0 });
/// Space left for runs, megabytes: a mission takes about 100 MB an hour, so two hours are left. Space that is freed
/// only for a moment does not clear the alarm.
pub const DISK_MB: ByMotion =
    ByMotion::same(Limit { alarm: 200.0, clear: 300.0, on_delay_s: 0.0, off_delay_s: 5.0 });

/// The state of the recording.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Recording {
    /// No recording was requested.
    #[default]
    Off,
    /// Everything is being recorded.
    On,
    /// The recording failed, with the reason.
    Failed(String),
}

/// The health of a run's engine.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Health {
    /// The state of the recording.
    pub recording: Recording,
    /// The speed actually achieved, as a multiple of the wall clock; `None` if it is not measured.
    pub reached_speed: Option<f64>,
    /// The number of ticks whose events are waiting to be written.
    #[serde(default)]
    pub recorder_lag: u64,
}

/// A measurement of the console itself.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Measured {
    /// The responsiveness of the screen.
    Screen {
        /// The 99th percentile of the time from a key press to its frame, milliseconds; `None` without recent keys.
        response_ms: Option<f64>,
        /// The number of frames skipped in the last ten seconds.
        skipped: u32,
    },
    /// The space left on the disk that holds the runs, bytes.
    Disk(u64),
}

/// The figures that are compared with their limits.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Watches {
    /// Time from a key press to its frame.
    pub response: Watch,
    /// Frames skipped.
    pub frames: Watch,
    /// Ticks by which the recorder is behind the mission.
    pub recorder_lag: Watch,
    /// Disk space left for runs.
    pub disk: Watch,
}

impl Watches {
    /// Whether one of the screen's figures must be measured again even if nothing happens.
    pub(super) fn is_pending(&self) -> bool {
        self.response.is_pending() || self.frames.is_pending()
    }
}
