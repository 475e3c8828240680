//! The command line and its list.

use super::line_edit::LineEdit;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The command line and its list.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Palette {
    /// Whether it was opened as help, with every key shown.
    pub help: bool,
    /// What was typed.
    pub line: LineEdit,
    /// Which line of the list is selected.
    pub selected: usize,
    /// How many lines back in the history the line is; 0 is a new one.
    pub recalled: usize,
    /// What is wrong with the line.
    pub fault: Option<LineFault>,
}

/// What is wrong with a part of a command line.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LineFault {
    /// Bytes of the line.
    pub at: Range<usize>,
    /// What is wrong with them and what would be right, as a clause.
    pub what: String,
}

impl Palette {
    /// A command line with a beginning.
    pub fn begun(text: &str) -> Self {
        Self { line: text.into(), ..Self::default() }
    }
}
