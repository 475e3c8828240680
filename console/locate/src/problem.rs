//! What is wrong with a row.

use std::fmt;

/// A row that cannot be used, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// Line of the file, or number of the message, from 1.
    pub line: u64,
    /// The column.
    pub column: Option<String>,
    /// What is wrong, and what would be right.
    pub what: String,
    /// Whether what follows it cannot be read.
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
