//! What reaches stdout and stderr.

use anyhow::Context;
use std::io::{ErrorKind, Write};

/// Writes a text to stdout; a reader that has gone away, as `head` does, is no fault.
pub(crate) fn say(text: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written.context("writing to stdout"),
    }
}

/// Writes a line to stdout, as [`say`].
pub(crate) fn say_line(line: &str) -> anyhow::Result<()> {
    say(&format!("{line}\n"))
}

/// Writes a line to stderr, in one piece; a line that cannot be written is dropped, because there is no other place to
/// report that, and the exit code still says how it went.
pub(crate) fn warn_line(line: &str) {
    let _ = std::io::stderr().write_all(format!("{line}\n").as_bytes());
}
