//! Labelled lines and numbers for the human-readable summary.

use std::fmt::{Display, Write};

/// Width of the column of labels.
const LABEL: usize = 15;

/// Labelled lines.
pub(crate) struct Text(pub(crate) String);

impl Text {
    /// A text under a title.
    pub(crate) fn new(title: &str) -> Self {
        Self(format!("{title}\n\n"))
    }

    pub(crate) fn line(&mut self, label: &str, what: impl Display) {
        let width = LABEL.max(label.len() + 1);
        writeln!(self.0, "{label:<width$}{what}").expect("writing to a string");
    }

    pub(crate) fn some(&mut self, label: &str, what: Option<impl Display>) {
        if let Some(what) = what {
            self.line(label, what);
        }
    }

    /// Lines under one label, which is not repeated.
    pub(crate) fn lines(&mut self, lines: impl IntoIterator<Item = (&'static str, String)>) {
        for (label, what) in lines {
            let begun = self.0.lines().any(|line| line.starts_with(&format!("{label:<LABEL$}")));
            self.line(if begun { "" } else { label }, what);
        }
    }
}

/// The overlap of a scan with its definition.
pub(crate) fn overlap(share: f64) -> String {
    format!("{} of scanned floor (scanned more than once)", percent(share))
}

/// A count with its noun in singular or plural.
pub(crate) fn counted(n: u64, what: &str) -> String {
    if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") }
}

/// A percentage in the format used everywhere.
pub(crate) fn percent(share: f64) -> String {
    format!("{:.1} %", world::coverage::percent(share))
}
