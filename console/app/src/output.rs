//! Results as JSON and as files.

use anyhow::Context;
use flight::failure::bad_input;
use report::print::say_line;
use serde::Serialize;
use std::{io, path::Path};

/// A value as JSON for people to read; `name` is what an error calls it.
pub(crate) fn pretty_json(name: &str, value: &impl Serialize) -> anyhow::Result<String> {
    let text = serde_json::to_string_pretty(value).with_context(|| format!("writing {name} as JSON"))?;
    Ok(text + "\n")
}

/// Writes a value to stdout as a line of JSON; `name` is what an error calls it.
pub(crate) fn say_json(name: &str, value: &impl Serialize) -> anyhow::Result<()> {
    Ok(say_line(&serde_json::to_string(value).with_context(|| format!("writing {name} as JSON"))?)?)
}

/// Writes a file that the user asked for, whole or not at all; `name` is what an error calls it.
pub(crate) fn write_file(name: &str, file: &Path, text: &str) -> anyhow::Result<()> {
    runs::write_whole(file, text.as_bytes()).map_err(|error| {
        let why = format!("{name} cannot be written: {error}: {}", file.display());
        if is_of_machine(&error) { anyhow::anyhow!(why) } else { bad_input(why) }
    })
}

/// Whether an error is one of the machine: another file name would not help.
fn is_of_machine(error: &io::Error) -> bool {
    use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
    // EIO has no kind of its own.
    matches!(error.kind(), StorageFull | QuotaExceeded | FileTooLarge) || error.raw_os_error() == Some(5)
}
