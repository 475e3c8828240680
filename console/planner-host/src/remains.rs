//! What planners leave besides their answers: what they print, and what is left of one that failed. It depends on the machine
//! when it arrives, so it enters neither journal nor recording.

use mission::{Cause, Fault};
use std::fmt;

/// A line that a planner printed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Printed {
    /// Which planner; empty while its plugin is being loaded.
    pub planner: String,
    /// The line, without control characters.
    pub line: String,
}

/// What is left of a planner that failed: enough to ask its plugin the same again ([`crate::replay`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Crash {
    /// How it failed.
    pub fault: Fault,
    /// The last requests, as they went to its worker.
    pub frames: Vec<u8>,
    /// The end of what it printed.
    pub output: String,
}

/// A planner that ended badly when it was no longer needed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BadEnd {
    /// Which.
    pub planner: String,
    /// How it ended; reads on after its name.
    pub how: String,
}

impl fmt::Display for BadEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "planner {} {} while it was destroyed", self.planner, self.how)
    }
}

/// Whether an author has to find out why: the planner did not refuse by itself, and the console did not refuse it.
pub(crate) fn is_crash(cause: Cause) -> bool {
    !matches!(cause, Cause::Planner(_) | Cause::Refused | Cause::Quarantined | Cause::Starved)
}
