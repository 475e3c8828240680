//! The record of a planner in shadow, counted from its events. The mission and all readers of events count in the same
//! way.

use super::EventKind;
use serde::{Deserialize, Serialize};

/// Number of steps in a row that a planner in shadow must have answered before it can take over.
pub const READY_AFTER: u64 = 10;

/// The record of a planner in shadow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ShadowTally {
    /// Number of steps answered in time.
    pub answered: u64,
    /// Number of steps answered since the last missed one.
    pub in_row: u64,
    /// Number of steps missed.
    pub missed: u64,
}

impl ShadowTally {
    /// Counts one event.
    pub fn apply(&mut self, event: &EventKind) {
        match event {
            EventKind::Shadowed { of } if matches!(**of, EventKind::Commanded { .. }) => {
                self.answered += 1;
                self.in_row += 1;
            }
            EventKind::ShadowMissed { ticks, .. } => {
                self.missed += ticks;
                self.in_row = 0;
            }
            _ => {}
        }
    }

    /// Whether the planner can take over.
    pub fn is_ready(&self) -> bool {
        self.in_row >= READY_AFTER
    }
}
