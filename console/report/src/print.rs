//! What reaches stdout and stderr: nothing that would control the terminal.

use std::{
    borrow::Cow,
    io::{self, ErrorKind, Write},
};

/// Writes a text to stdout, without what would control the terminal; a reader that has gone away, as `head` does, is no
/// fault.
///
/// # Errors
/// What the system says.
pub fn say(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(printable(text).as_bytes()).and_then(|()| out.flush()) {
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
    let _ = io::stderr().write_all(format!("{}\n", printable(line)).as_bytes());
}

/// Texts come from journals, scenarios and plugins, too: a control character in one is shown, not sent.
fn printable(text: &str) -> Cow<'_, str> {
    let controls = |c: char| c.is_control() && c != '\n' && c != '\t';
    if text.contains(controls) { text.replace(controls, "\u{fffd}").into() } else { text.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_controls_the_terminal() {
        assert_eq!(printable("a\tb\nc °"), "a\tb\nc °");
        assert_eq!(printable("\u{1b}[31mred\u{7}\r\u{9b}x"), "\u{fffd}[31mred\u{fffd}\u{fffd}\u{fffd}x");
    }
}
