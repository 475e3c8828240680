//! Failures by who has to act: the user or the developers.

use crate::output::warn_line;
use std::{fmt, process::ExitCode};

/// The mission was flown and is complete.
pub(crate) const COMPLETE: u8 = 0;
/// The mission was flown and ended otherwise; also a verification that found a difference.
pub(crate) const ENDED_OTHERWISE: u8 = 1;
/// Usage or input is wrong.
pub(crate) const BAD_INPUT: u8 = 2;
/// A fault of the program or the machine.
pub(crate) const INTERNAL: u8 = 3;

/// An input error that the user can fix; its text is complete, with place and remedy.
#[derive(Debug)]
pub(crate) struct BadInput(pub String);

impl fmt::Display for BadInput {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for BadInput {}

/// A failure of input, as an error.
pub(crate) fn bad_input(text: impl Into<String>) -> anyhow::Error {
    BadInput(text.into()).into()
}

/// Reports a failure on stderr; the exit code distinguishes input errors from internal ones.
pub(crate) fn report(error: &anyhow::Error) -> ExitCode {
    if let Some(BadInput(text)) = error.downcast_ref() {
        let prefix = if text.starts_with("error") { "" } else { "error: " };
        warn_line(&format!("{prefix}{}", text.trim_end()));
        return ExitCode::from(BAD_INPUT);
    }
    warn_line(&format!("error: {error:#}"));
    ExitCode::from(INTERNAL)
}
