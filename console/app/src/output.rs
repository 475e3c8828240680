//! What reaches stdout and stderr.

use crate::failure::bad_input;
use anyhow::Context;
use serde::Serialize;
use std::{
    borrow::Cow,
    io::{ErrorKind, Write},
    path::Path,
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

/// A value as JSON for people to read; `name` is what an error calls it.
pub(crate) fn pretty_json(name: &str, value: &impl Serialize) -> anyhow::Result<String> {
    let text = serde_json::to_string_pretty(value).with_context(|| format!("writing {name} as JSON"))?;
    Ok(text + "\n")
}

/// Writes a value to stdout as a line of JSON; `name` is what an error calls it.
pub(crate) fn say_json(name: &str, value: &impl Serialize) -> anyhow::Result<()> {
    say_line(&serde_json::to_string(value).with_context(|| format!("writing {name} as JSON"))?)
}

/// Writes a file that the user asked for; `name` is what an error calls it.
pub(crate) fn write_file(name: &str, file: &Path, text: &str) -> anyhow::Result<()> {
    std::fs::write(file, text)
        .map_err(|error| bad_input(format!("{name} cannot be written: {error}: {}", file.display())))
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
