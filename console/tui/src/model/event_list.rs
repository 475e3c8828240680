//! The list of events: which lines pass the filter, which is selected, and whether it is open.

use super::log::matches::Matches;
use serde::{Deserialize, Serialize};

/// The list of events.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct EventList {
    /// The lines that pass the filter.
    pub matches: Matches,
    /// Number of the selected line; `None`: the newest one, whichever that is.
    pub at: Option<u64>,
    /// Whether the whole event is shown.
    pub is_open: bool,
}

impl EventList {
    /// How many lines that pass are newer than the selected one.
    pub fn newer(&self) -> usize {
        let newer = self.at.map_or(0, |at| self.matches.newer_than(at));
        newer.min(self.matches.len().saturating_sub(1))
    }

    /// Number of the selected line.
    pub fn selected(&self) -> Option<u64> {
        self.matches.number(self.newer())
    }

    /// Selects another line, so many further down, that is older.
    pub fn select(&mut self, by: isize) {
        let newer = self.newer().saturating_add_signed(by);
        self.at = if newer == 0 { None } else { self.matches.number(newer) };
    }
}
