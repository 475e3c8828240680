//! The printed output of planners, the remains of planners that failed, and the bad ends of planners.
//! The time at which these arrive depends on the machine, so they are kept out of both the journal and the recording.

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

/// The remains of a planner that failed: enough to send its last requests to the plugin again ([`crate::replay`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Crash {
    /// The fault.
    pub fault: Fault,
    /// The last requests, as they were sent to the worker.
    pub frames: Vec<u8>,
    /// The end of its printed output.
    pub output: String,
}

/// A planner that did not end cleanly when it was no longer needed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BadEnd {
    /// The planner's id.
    pub planner: String,
    /// How the planner ended; completes a sentence that begins with its id.
    pub how: String,
}

impl fmt::Display for BadEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "planner {} {} while being destroyed", self.planner, self.how)
    }
}

/// Whether the author must find out why the planner failed: the planner did not refuse the request, and the console did
/// not refuse the planner.
pub(crate) fn is_crash(cause: Cause) -> bool {
    !matches!(cause, Cause::Planner(_) | Cause::Refused | Cause::Quarantined | Cause::Starved)
}
