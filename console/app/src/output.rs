//! What reaches stdout.

use anyhow::Context;
use std::io::{ErrorKind, Write};

/// Writes a text to stdout; a reader that has gone away, as `head` does, is no fault.
pub fn say(text: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written.context("writing to stdout"),
    }
}

/// Writes a line to stdout, as [`say`].
pub fn say_line(line: &str) -> anyhow::Result<()> {
    say(&format!("{line}\n"))
}
