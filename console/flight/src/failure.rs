//! Classifies failures by who must act: the user or the developers.

use account::Summary;
use mission::Outcome;
use recording::JournalError;
use runs::{Kept, RunError};
use std::fmt;

/// The mission was flown, is complete, and kept all bounds of its scenario (`[expect]`).
pub const COMPLETE: u8 = 0;
/// The mission was flown, but ended without being complete or did not keep a bound. Also used for a verification that
/// found a difference.
pub const ENDED_OTHERWISE: u8 = 1;
/// Wrong usage or wrong input.
pub const BAD_INPUT: u8 = 2;
/// A fault of the program or the machine.
pub const INTERNAL: u8 = 3;

/// An input error that the user can fix; its text is complete, including the place and the remedy.
#[derive(Debug)]
pub struct BadInput(pub String);

impl fmt::Display for BadInput {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for BadInput {}

/// Creates an input error.
pub fn bad_input(text: impl Into<String>) -> anyhow::Error {
    BadInput(text.into()).into()
}

/// Whether a failure is an input error; this includes a journal that cannot be read and a folder that cannot take runs.
pub fn is_input(error: &anyhow::Error) -> bool {
    let of_run = error.downcast_ref::<RunError>().is_some_and(RunError::is_input);
    of_run || error.is::<BadInput>() || error.is::<JournalError>()
}

/// The exit code of a mission that was flown.
pub fn mission_code(flown: &Summary) -> u8 {
    let keeps_bounds = flown.violations.as_ref().is_none_or(Vec::is_empty);
    if flown.outcome == Some(Outcome::Complete) && keeps_bounds { COMPLETE } else { ENDED_OTHERWISE }
}

/// The exit code of a run, given the result of its mission. A run that should have been kept but was not is a fault.
pub fn exit_code(mission: u8, kept: Option<&Kept>) -> u8 {
    if kept.is_some_and(|kept| kept.problem().is_some()) { INTERNAL } else { mission }
}
