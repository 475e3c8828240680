//! What reaches stdout and stderr: plain text, whoever wrote the names in it.

use foreign::plain_lines;
use std::io::{self, ErrorKind, Write};

/// Writes a text to stdout, in plain characters; a reader that has gone away, as `head` does, is no
/// fault.
///
/// # Errors
/// What the system says.
pub fn say(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(plain_lines(text).as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(io::Error::new(error.kind(), format!("writing to stdout: {error}"))),
        Ok(()) => Ok(()),
    }
}

/// Writes a line to stdout, as [`say`].
///
/// # Errors
/// See [`say`].
pub fn say_line(line: &str) -> io::Result<()> {
    say(&format!("{line}\n"))
}

/// Writes a line to stderr, in one piece; a line that cannot be written is dropped, because there is no other place to
/// report that, and the exit code still says how it went.
pub fn warn_line(line: &str) {
    let _ = io::stderr().write_all(format!("{}\n", plain_lines(line)).as_bytes());
}
