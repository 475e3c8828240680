//! What the operator types to find events: terms that all have to hold.
//!
//! ```text
//! sev>=watch source=ae,tether station=C t>00:05 "position lost" -text
//! ```

mod term;
mod word;

use super::chunk::Line;
use super::entry::severity_word;
use mission::Severity;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use term::Term;
use word::{Word, words};

/// A filter as it was understood.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Filter {
    terms: Vec<Term>,
    /// What was not understood, in the order of the text; it filters nothing.
    pub problems: Vec<Problem>,
}

/// A part of a filter that was not understood.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Problem {
    /// Where it stands in the text, bytes.
    pub at: Range<usize>,
    /// Why, as a sentence.
    pub why: String,
}

impl Filter {
    /// Understands as much of a text as it can. Terms are separated by spaces.
    pub fn parse(text: &str) -> Self {
        let mut filter = Self::default();
        for word in words(text) {
            match Term::parse(&word) {
                Ok(term) => filter.terms.push(term),
                Err(why) => filter.problems.push(Problem { at: word.at, why }),
            }
        }
        filter
    }

    /// Whether a line passes. What is critical always does.
    pub(super) fn passes(&self, line: &Line) -> bool {
        line.severity == Severity::Crit || self.terms.iter().all(|term| term.passes(line))
    }

    /// The least severity that it asks for.
    pub fn least(&self) -> Severity {
        self.terms.iter().filter_map(Term::least).max().unwrap_or(Severity::Info)
    }
}

/// A text with another least severity instead of its own.
pub fn with_least(text: &str, least: Severity) -> String {
    let rest = without_least(text);
    match least {
        Severity::Info => rest,
        _ => format!("sev>={} {rest}", severity_word(least).to_lowercase()).trim_end().to_owned(),
    }
}

/// A text without its least severity.
pub fn without_least(text: &str) -> String {
    let is_kept = |word: &Word| Term::parse(word).ok().and_then(|term| term.least()).is_none();
    let kept: Vec<&str> = words(text).filter(is_kept).map(|word| &text[word.at]).collect();
    kept.join(" ")
}

#[cfg(test)]
mod tests;
