//! What is wrong with a file.

use crate::input::Input;
use std::{fs, path::Path};

/// A larger file is not taken, bytes.
pub(crate) const LARGEST_BYTES: u64 = 100_000_000;

/// What is wrong with a file, and where.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file}{}{}: {what}", line.map(|line| format!(", line {line}")).unwrap_or_default(),
    key.as_ref().map(|key| format!(", {key}")).unwrap_or_default())]
pub struct ImportError {
    /// The file.
    pub file: String,
    /// Line in it, from 1.
    pub line: Option<usize>,
    /// Key or column in that line.
    pub key: Option<String>,
    /// What is wrong and what would be right.
    pub what: String,
}

impl ImportError {
    /// Something that concerns the whole of an input.
    pub(crate) fn of_input(input: &Input, what: impl Into<String>) -> Self {
        Self { file: input.name.clone(), line: None, key: None, what: what.into() }
    }

    /// Something that concerns the whole file.
    pub(crate) fn of_file(file: &Path, what: impl Into<String>) -> Self {
        Self { file: file.display().to_string(), line: None, key: None, what: what.into() }
    }
}

/// The bytes of a plain file that is not too large.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, ImportError> {
    let of_file = |what: String| ImportError::of_file(path, what);
    let unreadable = |error: std::io::Error| of_file(format!("cannot be read: {error}"));
    // Looked at before it is opened, since opening a pipe waits for a writer.
    let about = fs::metadata(path).map_err(unreadable)?;
    if about.is_dir() {
        return Err(of_file("is a folder; name a file in it".into()));
    }
    if !about.is_file() {
        return Err(of_file("is not a regular file; save what it gives to a file first".into()));
    }
    if about.len() > LARGEST_BYTES {
        let (size, most) = (about.len() / 1_000_000, LARGEST_BYTES / 1_000_000);
        return Err(of_file(format!("{size} MB; files of at most {most} MB are read")));
    }
    if about.len() == 0 {
        return Err(of_file("is empty".into()));
    }
    fs::read(path).map_err(unreadable)
}
