//! Errors in imported files.

use crate::input::Input;
use std::{fs, path::Path};

/// The size of the largest file that is read, in bytes.
pub(crate) const LARGEST_BYTES: u64 = 100_000_000;

/// A problem in a file, and its position.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file}{}{}: {what}", line.map(|line| format!(", line {line}")).unwrap_or_default(),
    key.as_ref().map(|key| format!(", {key}")).unwrap_or_default())]
pub struct ImportError {
    /// The name of the file.
    pub file: String,
    /// The line, from 1.
    pub line: Option<usize>,
    /// The key or column in that line.
    pub key: Option<String>,
    /// The problem, and how to correct it.
    pub what: String,
}

impl ImportError {
    /// A problem that concerns an entire input.
    pub(crate) fn of_input(input: &Input, what: impl Into<String>) -> Self {
        Self { file: input.name.clone(), line: None, key: None, what: what.into() }
    }

    /// A problem that concerns an entire file.
    pub(crate) fn of_file(file: &Path, what: impl Into<String>) -> Self {
        Self { file: file.display().to_string(), line: None, key: None, what: what.into() }
    }
}

/// Reads a regular file that is not too large.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, ImportError> {
    let of_file = |what: String| ImportError::of_file(path, what);
    let unreadable = |error: std::io::Error| of_file(format!("cannot be read: {error}"));
    // Check this before opening the file: opening a pipe would wait for a writer.
    let about = fs::metadata(path).map_err(unreadable)?;
    if about.is_dir() {
        return Err(of_file("is a folder; name a file in it".into()));
    }
    if !about.is_file() {
        return Err(of_file("is not a regular file; save its contents to a file first".into()));
    }
    if about.len() > LARGEST_BYTES {
        let (size, most) = (about.len() / 1_000_000, LARGEST_BYTES / 1_000_000);
        return Err(of_file(format!("{size} MB; files may have at most {most} MB")));
    }
    if about.len() == 0 {
        return Err(of_file("is empty".into()));
    }
    fs::read(path).map_err(unreadable)
}
