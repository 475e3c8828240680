//! Output to stdout and stderr in plain characters, even if names in it come from untrusted sources.

use foreign::plain_lines;
use std::io::{self, ErrorKind, Write};

/// Writes a text to stdout in plain characters. A reader that has closed the pipe, such as `head`, is not an error.
///
/// # Errors
/// The system's error.
pub fn say(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(plain_lines(text).as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(io::Error::new(error.kind(), format!("writing to stdout: {error}"))),
        Ok(()) => Ok(()),
    }
}

/// Writes a line to stdout; see [`say`].
///
/// # Errors
/// See [`say`].
pub fn say_line(line: &str) -> io::Result<()> {
    say(&format!("{line}\n"))
}

/// Writes a line to stderr in one piece. A line that cannot be written is dropped: there is no other place to report
/// the failure, and the exit code still states the result.
pub fn warn_line(line: &str) {
    let _ = io::stderr().write_all(format!("{}\n", plain_lines(line)).as_bytes());
}
