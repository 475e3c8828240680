//! What is wrong with a file of readings.

use super::columns::Kind;
use crate::problem::Problem;
use serde::Serialize;
use std::collections::BTreeMap;

/// Maximum number of faults that are listed one by one, and of those of one kind.
const LISTED: usize = 20;
const LISTED_OF_KIND: u64 = 5;

/// The faults of one kind.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Fault {
    /// Number of readings or rows.
    pub count: u64,
    /// The first line.
    pub first_line: u64,
    /// The last line.
    pub last_line: u64,
}

/// The faults of a file.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Faults {
    /// The faults by kind.
    pub kinds: BTreeMap<Kind, Fault>,
    /// The first faults of each kind, each as a line for people.
    pub listed: Vec<String>,
}

impl Faults {
    pub(super) fn note(&mut self, kind: Kind, problem: &Problem) {
        let line = problem.line;
        let fault = self.kinds.entry(kind).or_insert(Fault { count: 0, first_line: line, last_line: line });
        fault.count += 1;
        fault.last_line = line;
        if self.listed.len() < LISTED && fault.count <= LISTED_OF_KIND {
            self.listed.push(problem.to_string());
        }
    }

    /// Number of faults.
    pub fn count(&self) -> u64 {
        self.kinds.values().map(|fault| fault.count).sum()
    }

    /// Number of faults that are not listed.
    pub fn unlisted(&self) -> u64 {
        self.count() - self.listed.len() as u64
    }
}
