//! After the task is done, the robot stands still until the stations have tested each other once more.

use super::{Mission, known::Known};
use crate::event::{EventKind, PulsePhase};
use positioning::PulseError;

/// The longest wait for the last pulses, as a multiple of the time after which the stations exchange them.
const WAIT_RESTS: f64 = 2.0;
/// What the wait exceeds this multiple by, seconds: the robot needs time to stop, and the stations to answer.
const SPARE_S: f64 = 10.0;

/// The end of a mission that is done, until the last pulses have come.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Finishing {
    /// Mission time at which the mission ends without them, seconds; `None` while the robot is held.
    until_s: Option<f64>,
    /// Whether they have come, also while the robot was held.
    is_tested: bool,
}

impl Known {
    /// Interrupts the wait, because the robot is held.
    pub(super) fn hold_finish(&mut self) {
        self.finishing.iter_mut().for_each(|finishing| finishing.until_s = None);
    }

    /// Ends the wait, because the robot moves on.
    pub(super) fn leave_finish(&mut self) {
        if self.finishing.take().is_some() {
            self.locator.end_ranging(false);
        }
    }
}

impl Mission {
    /// Notes pulses that came in this tick.
    pub(super) fn note_last_pulses(&mut self) {
        let is_test = |kind: &EventKind| {
            matches!(kind, EventKind::PulsesTested { .. } | EventKind::PulsesFailed { .. })
        };
        let has_come = self.happened.has(is_test);
        self.known.finishing.iter_mut().for_each(|finishing| finishing.is_tested |= has_come);
    }

    /// Whether the mission that is done has to wait for the pulse test after the run. The robot stands still meanwhile; a
    /// hold interrupts the wait.
    pub(super) fn waits_for_pulses(&mut self) -> bool {
        let Some(rest_s) = self.known.config.locating.pulse_rest_s else { return false };
        let now_s = self.known.now_s();
        if self.known.finishing.is_none() {
            self.known.locator.end_ranging(true);
        }
        let finishing = self.known.finishing.get_or_insert_default();
        match finishing.until_s {
            _ if finishing.is_tested => false,
            Some(until_s) => now_s < until_s,
            None => {
                let limit_s = self.rules.time_limit.ends_s(&self.known.config);
                let until_s = (now_s + WAIT_RESTS * rest_s + SPARE_S).min(limit_s);
                finishing.until_s = Some(until_s);
                self.happened.push(EventKind::PulsesAwaited { until_s });
                true
            }
        }
    }

    /// Reports that the last pulses have not come, if the mission ends without them.
    pub(super) fn report_missing_pulses(&mut self) {
        if self.known.finishing.is_some_and(|finishing| !finishing.is_tested) {
            let (phase, why) = (PulsePhase::After, PulseError::Missing);
            self.happened.push(EventKind::PulsesFailed { phase, why });
        }
    }
}
