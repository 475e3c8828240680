//! Failures by who has to act: the user or the developers.

use account::Summary;
use mission::Outcome;
use recording::JournalError;
use runs::{Kept, RunError};
use std::fmt;

/// The mission was flown, is complete, and kept the bounds of its scenario (`[expect]`).
pub const COMPLETE: u8 = 0;
/// The mission was flown and ended otherwise, or did not keep a bound; also a verification that found a difference.
pub const ENDED_OTHERWISE: u8 = 1;
/// Usage or input is wrong.
pub const BAD_INPUT: u8 = 2;
/// A fault of the program or the machine.
pub const INTERNAL: u8 = 3;

/// An input error that the user can fix; its text is complete, with place and remedy.
#[derive(Debug)]
pub struct BadInput(pub String);

impl fmt::Display for BadInput {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for BadInput {}

/// A failure of input, as an error.
pub fn bad_input(text: impl Into<String>) -> anyhow::Error {
    BadInput(text.into()).into()
}

/// Whether a failure is one of input: also a journal that cannot be read, or a folder that takes no run.
pub fn is_input(error: &anyhow::Error) -> bool {
    let of_run = error.downcast_ref::<RunError>().is_some_and(RunError::is_input);
    of_run || error.is::<BadInput>() || error.is::<JournalError>()
}

/// The exit code of a mission that was flown.
pub fn mission_code(flown: &Summary) -> u8 {
    let keeps_bounds = flown.violations.as_ref().is_none_or(Vec::is_empty);
    if flown.outcome == Some(Outcome::Complete) && keeps_bounds { COMPLETE } else { ENDED_OTHERWISE }
}

/// The exit code of a run with this result of its mission: a run that was to be kept and is not is a fault.
pub fn exit_code(mission: u8, kept: Option<&Kept>) -> u8 {
    if kept.is_some_and(|kept| kept.problem().is_some()) { INTERNAL } else { mission }
}
