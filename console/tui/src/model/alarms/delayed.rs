//! Causes that wait for their delay before they become alarms, or before their alarms clear.

use super::{Cause, Reading};
use mission::Severity;
use serde::{Deserialize, Serialize};
use world::Point;

/// What happens to the alarm of a cause when the delay is over.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) enum Next {
    /// The alarm is raised.
    Raise {
        severity: Severity,
        text: String,
        /// The log line of the cause, and the position to which the line refers.
        line: Option<(u64, Option<Point>)>,
        /// The values of the alarm's figure since the cause began, with their times.
        readings: Vec<(f64, Reading)>,
    },
    /// The alarm clears.
    Clear,
}

/// A cause that waits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Delayed {
    pub cause: Cause,
    pub next: Next,
    /// Mission time at which the wait began, seconds.
    pub since_s: f64,
    pub delay_s: f64,
}

impl Delayed {
    /// Whether the delay is over. A cause that changes exactly at the end of its delay has not outlasted it.
    pub(super) fn is_due(&self, t_s: f64) -> bool {
        t_s > self.since_s + self.delay_s + 1e-9
    }
}
