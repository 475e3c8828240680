//! The age of the readings of a vehicle.

use std::collections::VecDeque;

/// Maximum number of ages kept.
const MOST_AGES: usize = 1024;

/// The ages of the last readings on arrival.
#[derive(Debug, Default)]
pub(super) struct Ages(VecDeque<f64>);

impl Ages {
    pub(super) fn add(&mut self, age_s: f64) {
        if self.0.len() == MOST_AGES {
            self.0.pop_front();
        }
        self.0.push_back(age_s);
    }

    /// The age that 99 % of them do not exceed, seconds.
    pub(super) fn p99_s(&self) -> Option<f64> {
        let mut sorted: Vec<f64> = self.0.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        let rank = (0.99 * sorted.len() as f64).ceil() as usize;
        sorted.get(rank.saturating_sub(1)).copied()
    }
}
