//! What reaches stdout and stderr.

use anyhow::Context;
use std::{
    borrow::Cow,
    io::{ErrorKind, Write},
};

/// Writes a text to stdout, without what would control the terminal; a reader that has gone away, as `head` does, is no
/// fault.
pub(crate) fn say(text: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(printable(text).as_bytes()).and_then(|()| out.flush()) {
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
    let _ = std::io::stderr().write_all(format!("{}\n", printable(line)).as_bytes());
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
