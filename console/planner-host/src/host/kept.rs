//! Keeps the output, crashes and bad ends of planners until the caller collects them.

use crate::remains::{BadEnd, Crash, Printed};

/// The maximum number of lines kept; the newest ones stay.
const MOST_PRINTED: usize = 256;
/// The maximum number of crashes kept.
const MOST_CRASHES: usize = 4;
/// The maximum number of entries kept about planners that ended badly.
const MOST_BAD_ENDS: usize = 16;

/// The output, crashes and bad ends that the caller has not collected yet.
#[derive(Default)]
pub(super) struct Kept {
    pub(super) printed: Vec<Printed>,
    pub(super) crashes: Vec<Crash>,
    pub(super) bad_ends: Vec<BadEnd>,
}

impl Kept {
    pub(super) fn note_printed(&mut self, planner: &str, lines: Vec<String>) {
        let printed = |line| Printed { planner: planner.to_owned(), line };
        self.printed.extend(lines.into_iter().map(printed));
        let surplus = self.printed.len().saturating_sub(MOST_PRINTED);
        self.printed.drain(..surplus);
    }

    pub(super) fn note_crash(&mut self, crash: Crash) {
        if self.crashes.len() < MOST_CRASHES {
            self.crashes.push(crash);
        }
    }

    /// Notes that a planner ended badly. A worker without a planner is ignored, because no author needs to know about
    /// it.
    pub(super) fn note_bad_end(&mut self, end: BadEnd) {
        if !end.planner.is_empty() && self.bad_ends.len() < MOST_BAD_ENDS {
            self.bad_ends.push(end);
        }
    }
}
