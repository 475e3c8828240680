//! Input files; `-` reads standard input.

use flight::failure::bad_input;
use std::{
    io::{self, IsTerminal, Read},
    path::{Path, PathBuf},
};
use tempfile::NamedTempFile;

/// The largest number of bytes read from a pipe.
const MOST_PIPED: u64 = 2_000_000_000;

/// An input file that can be read several times.
pub(crate) struct Input {
    path: PathBuf,
    shown: String,
    /// The copy of the piped input, deleted when this is dropped.
    _piped: Option<NamedTempFile>,
}

impl Input {
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The name of the file for messages.
    pub(crate) fn shown(&self) -> &str {
        &self.shown
    }
}

/// Opens the file with this name; `-` is standard input.
pub(crate) fn file(path: &Path) -> anyhow::Result<Input> {
    if path != Path::new("-") {
        return Ok(Input { path: path.to_owned(), shown: path.display().to_string(), _piped: None });
    }
    if io::stdin().is_terminal() {
        return Err(bad_input("-: standard input is a terminal; pipe a file in, or name a file"));
    }
    let mut piped = NamedTempFile::new()?;
    let bytes = io::copy(&mut io::stdin().lock().take(MOST_PIPED + 1), &mut piped)?;
    if bytes > MOST_PIPED {
        return Err(bad_input("standard input: more than 2 GB; save it to a file and name the file"));
    }
    Ok(Input { path: piped.path().to_owned(), shown: "standard input".into(), _piped: Some(piped) })
}
