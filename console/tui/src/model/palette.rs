//! The command line and its list.

use super::line_edit::LineEdit;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The command line and its list.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Palette {
    /// Whether the list was opened as help, with every key shown.
    pub help: bool,
    /// The typed line.
    pub line: LineEdit,
    /// The index of the selected line in the list.
    pub selected: usize,
    /// How many lines back in the history this line was found; 0 for a new line.
    pub recalled: usize,
    /// The error in the line.
    pub fault: Option<LineFault>,
}

/// An error in part of a command line.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LineFault {
    /// The byte range in the line.
    pub at: Range<usize>,
    /// What is wrong and how to correct it, as a clause.
    pub what: String,
}

impl Palette {
    /// Opens a command line that already contains some text.
    pub fn begun(text: &str) -> Self {
        Self { line: text.into(), ..Self::default() }
    }
}
