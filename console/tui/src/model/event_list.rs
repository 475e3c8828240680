//! The list of events: the lines that pass the filter, and the selected line.

use super::log::matches::Matches;
use serde::{Deserialize, Serialize};

/// The list of events.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct EventList {
    /// The lines that pass the filter.
    pub matches: Matches,
    /// The number of the selected line; `None` to follow the newest one.
    pub at: Option<u64>,
}

impl EventList {
    /// The number of lines in the list that are newer than the selected one.
    pub fn newer(&self) -> usize {
        let newer = self.at.map_or(0, |at| self.matches.newer_than(at));
        newer.min(self.matches.len().saturating_sub(1))
    }

    /// The number of the selected line.
    pub fn selected(&self) -> Option<u64> {
        self.matches.number(self.newer())
    }

    /// Moves the selection down by `by` lines, towards older events.
    pub fn select(&mut self, by: isize) {
        let newer = self.newer().saturating_add_signed(by);
        self.at = if newer == 0 { None } else { self.matches.number(newer) };
    }
}
