//! What planners leave behind besides their answers: their printed output, and the remains of one that failed. When it
//! arrives depends on the machine, so it is kept out of both journal and recording.

use mission::{Cause, Fault};
use std::fmt;

/// A line that a planner printed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Printed {
    /// The planner's id; empty while its plugin is being loaded.
    pub planner: String,
    /// The line, without control characters.
    pub line: String,
}

/// The remains of a planner that failed: enough to repeat its last requests to the plugin ([`crate::replay`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Crash {
    /// The fault.
    pub fault: Fault,
    /// The last requests, as they were sent to the worker.
    pub frames: Vec<u8>,
    /// The end of its printed output.
    pub output: String,
}

/// A planner that ended badly when it was no longer needed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BadEnd {
    /// The planner's id.
    pub planner: String,
    /// How the planner ended; continues after its id.
    pub how: String,
}

impl fmt::Display for BadEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "planner {} {} while being destroyed", self.planner, self.how)
    }
}

/// Whether the author must find out why: neither did the planner refuse the request, nor did the console refuse the
/// planner.
pub(crate) fn is_crash(cause: Cause) -> bool {
    !matches!(cause, Cause::Planner(_) | Cause::Refused | Cause::Quarantined | Cause::Starved)
}
