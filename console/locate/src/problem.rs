//! Problems with rows.

use std::fmt;

/// A row that cannot be used, and the reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// Line of the file, or number of the message, from 1.
    pub line: u64,
    /// The name of the column.
    pub column: Option<String>,
    /// The problem and its remedy.
    pub what: String,
    /// Whether the rest of the file cannot be read.
    pub is_end: bool,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { line, column, what, .. } = self;
        match column {
            Some(column) => write!(f, "line {line}, {column}: {what}"),
            None => write!(f, "line {line}: {what}"),
        }
    }
}
