//! The event filter that the operator types: terms that must all match.
//!
//! ```text
//! sev>=watch source=ae,tether station=C t>00:05 "position lost" -text
//! ```
//!
//! The messages of planners about their own work pass only if a term asks for them: `sev>=debug`.

mod term;
mod word;

use super::chunk::Line;
use super::entry::severity_word;
use mission::Severity;
use serde::{Deserialize, Serialize};
use std::ops::Range;
use term::Term;
use word::{Word, words};

/// A parsed filter.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Filter {
    terms: Vec<Term>,
    /// The parts that could not be parsed, in order; filtering ignores them.
    pub problems: Vec<Problem>,
}

/// A part of a filter that could not be parsed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Problem {
    /// The range of bytes in the text of the filter.
    pub at: Range<usize>,
    /// The reason, as a sentence.
    pub why: String,
}

impl Filter {
    /// Parses as much of the text as possible. Terms are separated by spaces.
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

    /// Whether a line passes the filter. Critical lines always pass.
    pub(super) fn passes(&self, line: &Line) -> bool {
        let is_asked = line.severity > Severity::Debug || self.shows_debug();
        line.severity == Severity::Crit || is_asked && self.terms.iter().all(|term| term.passes(line))
    }

    /// Whether the messages of planners about their own work pass.
    pub fn shows_debug(&self) -> bool {
        self.terms.iter().any(Term::is_debug)
    }

    /// The minimum severity that the filter requires.
    pub fn least(&self) -> Severity {
        self.terms.iter().filter_map(Term::least).max().unwrap_or(Severity::Info)
    }
}

/// The filter text with its minimum severity replaced.
pub fn with_least(text: &str, least: Severity) -> String {
    let rest = without_least(text);
    match least {
        Severity::Debug | Severity::Info => rest,
        _ => format!("sev>={} {rest}", severity_word(least).to_lowercase()).trim_end().to_owned(),
    }
}

/// The filter text with its minimum severity replaced by one that all lines have, including the messages of planners
/// about their own work.
pub fn with_debug(text: &str) -> String {
    format!("sev>=debug {}", without_least(text)).trim_end().to_owned()
}

/// The filter text without its minimum severity.
pub fn without_least(text: &str) -> String {
    let is_kept = |word: &Word| Term::parse(word).ok().and_then(|term| term.least()).is_none();
    let kept: Vec<&str> = words(text).filter(is_kept).map(|word| &text[word.at]).collect();
    kept.join(" ")
}

#[cfg(test)]
mod tests;
