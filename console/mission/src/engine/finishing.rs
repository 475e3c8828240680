//! After the task is done, the robot stands still until the stations have tested each other once more.

use super::{Mission, known::Known};
use crate::event::{EventKind, PulsePhase};
use positioning::PulseError;

/// The longest wait for the last pulses, as a multiple of the time after which the stations exchange them.
const WAIT_RESTS: f64 = 2.0;
/// What the wait exceeds this multiple by, seconds: the robot needs time to stop, and the stations to answer.
const SPARE_S: f64 = 10.0;

/// The wait for the last pulses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Finishing {
    /// Mission time at which the mission ends without them, seconds.
    until_s: f64,
}

impl Known {
    /// Ends the wait, because the robot is held.
    pub(super) fn leave_finish(&mut self) {
        if self.finishing.take().is_some() {
            self.locator.end_ranging(false);
        }
    }
}

impl Mission {
    /// Whether the mission that is done has to wait for the pulse test after the run. The robot stands still meanwhile; a
    /// hold ends the wait, and the rest of the mission begins a new one.
    pub(super) fn waits_for_pulses(&mut self) -> bool {
        let Some(rest_s) = self.known.config.locating.pulse_rest_s else { return false };
        let now_s = self.known.now_s();
        let Some(Finishing { until_s }) = self.known.finishing else {
            let limit_s = self.rules.time_limit.ends_s(&self.known.config);
            let until_s = (now_s + WAIT_RESTS * rest_s + SPARE_S).min(limit_s);
            self.known.finishing = Some(Finishing { until_s });
            self.known.locator.end_ranging(true);
            self.happened.push(EventKind::PulsesAwaited { until_s });
            return true;
        };
        let is_tested = self
            .happened
            .has(|kind| matches!(kind, EventKind::PulsesTested { .. } | EventKind::PulsesFailed { .. }));
        if !is_tested && now_s >= until_s {
            let (phase, why) = (PulsePhase::After, PulseError::Missing);
            self.happened.push(EventKind::PulsesFailed { phase, why });
        }
        !is_tested && now_s < until_s
    }
}
