//! The text of a scenario and the problems found in it.

use super::problem::Problem;
use std::{cell::RefCell, ops::Range};

/// The largest number of problems noted.
const MOST_PROBLEMS: usize = 200;

/// The text and the problems found so far.
pub(crate) struct Source<'a> {
    /// The whole file.
    pub text: &'a str,
    problems: RefCell<Vec<Problem>>,
}

impl<'a> Source<'a> {
    /// Starts without problems.
    pub(crate) fn new(text: &'a str) -> Self {
        Self { text, problems: RefCell::default() }
    }

    /// Notes a problem, unless it is already noted or [`MOST_PROBLEMS`] has been reached.
    pub(crate) fn note(&self, problem: Problem) {
        if !self.is_full() && !self.problems.borrow().contains(&problem) {
            self.problems.borrow_mut().push(problem);
        }
    }

    /// Whether [`MOST_PROBLEMS`] has been reached; further problems are ignored.
    pub(crate) fn is_full(&self) -> bool {
        self.problems.borrow().len() >= MOST_PROBLEMS
    }

    /// All noted problems, in the order of the text.
    pub(crate) fn into_problems(self) -> Vec<Problem> {
        let mut problems = self.problems.into_inner();
        problems.sort_by_key(|problem| problem.at.as_ref().map(|at| at.start));
        problems
    }

    /// The text of a value, shortened and on one line.
    pub(crate) fn excerpt(&self, at: &Range<usize>) -> String {
        let written = self.text.get(at.clone()).unwrap_or_default();
        let mut line: String = written.split_whitespace().collect::<Vec<_>>().join(" ");
        line.retain(foreign::is_plain);
        if line.chars().count() > 40 {
            line = line.chars().take(39).chain(['…']).collect();
        }
        line
    }
}
