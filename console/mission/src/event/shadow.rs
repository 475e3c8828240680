//! How a planner does in shadow, by its events: the mission and everybody who reads the events count alike.

use super::EventKind;
use serde::{Deserialize, Serialize};

/// So many steps answered in a row, and a planner in shadow may take over.
pub const READY_AFTER: u64 = 10;

/// What a planner has done in shadow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ShadowTally {
    /// Steps that it answered in time.
    pub answered: u64,
    /// Of these, how many since it last missed a tick.
    pub in_row: u64,
    /// Ticks that it missed.
    pub missed: u64,
}

impl ShadowTally {
    /// Takes in one event.
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

    /// Whether it may take over.
    pub fn is_ready(&self) -> bool {
        self.in_row >= READY_AFTER
    }
}
