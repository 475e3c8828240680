//! What is wrong with a file.

use std::{fs, path::Path};

/// A larger file is not taken, bytes.
const LARGEST_BYTES: u64 = 64_000_000;

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
    /// Something that concerns the whole file.
    pub(crate) fn of_file(file: &Path, what: impl Into<String>) -> Self {
        Self { file: file.display().to_string(), line: None, key: None, what: what.into() }
    }
}

/// The bytes of a plain file that is not too large.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, ImportError> {
    let unreadable = |error: std::io::Error| ImportError::of_file(path, format!("cannot be read: {error}"));
    let about = fs::metadata(path).map_err(unreadable)?;
    if !about.is_file() || about.len() > LARGEST_BYTES {
        let what = format!("no plain file of at most {} MB", LARGEST_BYTES / 1_000_000);
        return Err(ImportError::of_file(path, what));
    }
    fs::read(path).map_err(unreadable)
}

/// The text of a plain file that is not too large.
pub(crate) fn read_text(path: &Path) -> Result<String, ImportError> {
    String::from_utf8(read_file(path)?).map_err(|error| {
        ImportError::of_file(path, format!("no UTF-8 text at byte {}", error.utf8_error().valid_up_to()))
    })
}
