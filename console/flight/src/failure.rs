//! Classifies failures according to who must act: the user or the developers.

use account::Summary;
use mission::Outcome;
use recording::JournalError;
use runs::{Kept, RunError, is_of_machine};
use std::{fmt, io, path::Path};

/// The mission ran, is complete, and met all bounds of its scenario (`[expect]`).
pub const COMPLETE: u8 = 0;
/// The mission ran, but ended incomplete, did not meet a bound, or did not confirm the stop of a real vehicle. Also used for a verification that found a difference.
pub const ENDED_OTHERWISE: u8 = 1;
/// Incorrect usage or invalid input.
pub const BAD_INPUT: u8 = 2;
/// A fault in the program or the machine.
pub const INTERNAL: u8 = 3;

/// An input error that the user can fix; its text is complete, with the place of the error and the remedy.
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

/// The error about a file named by the user that the system refused to write; messages call it `what`. A full or faulty
/// disk is not an input error.
pub fn not_written(what: &str, error: &io::Error, file: &Path) -> anyhow::Error {
    let why = format!("cannot write {what}: {error}: {}", file.display());
    if is_of_machine(error) { anyhow::anyhow!(why) } else { bad_input(why) }
}

/// Whether a failure is an input error; this includes journals that cannot be read, and folders in which runs cannot be
/// stored.
pub fn is_input(error: &anyhow::Error) -> bool {
    let of_run = error.downcast_ref::<RunError>().is_some_and(RunError::is_input);
    of_run || error.is::<BadInput>() || error.is::<JournalError>()
}

/// The exit code for a mission that ran.
pub fn mission_code(flown: &Summary) -> u8 {
    let keeps_bounds = flown.violations.as_ref().is_none_or(Vec::is_empty);
    let stands = flown.vehicle.as_ref().is_none_or(|vehicle| vehicle.stands != Some(false));
    if flown.outcome == Some(Outcome::Complete) && keeps_bounds && stands {
        COMPLETE
    } else {
        ENDED_OTHERWISE
    }
}

/// The exit code for a run, given the code for its mission. A run that should have been kept but was not counts as an
/// internal fault.
pub fn exit_code(mission: u8, kept: Option<&Kept>) -> u8 {
    if kept.is_some_and(|kept| kept.problem().is_some()) { INTERNAL } else { mission }
}
