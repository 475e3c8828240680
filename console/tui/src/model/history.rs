//! The values over the last minutes, for curves.

use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The mission time covered by a history, seconds.
pub const HISTORY_S: usize = 480;
/// The length of a slot, seconds of mission time. Only the largest value in a slot is kept, so a curve moves at most
/// once per slot.
pub const SLOT_S: usize = 4;

/// The largest value in each slot of [`SLOT_S`] seconds of mission time over the last [`HISTORY_S`] seconds, newest
/// last.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct History {
    values: VecDeque<f32>,
    slot: u64,
}

impl History {
    /// Adds a value.
    pub fn add(&mut self, t_s: f64, value: f64) {
        let slot = t_s.max(0.0) as u64 / SLOT_S as u64;
        let value = value as f32;
        match self.values.back_mut() {
            Some(last) if slot == self.slot => *last = last.max(value),
            _ => self.values.push_back(value),
        }
        self.slot = slot;
        if self.values.len() > HISTORY_S / SLOT_S {
            self.values.pop_front();
        }
    }

    /// Mission time at which the newest slot begins, seconds.
    pub fn newest_s(&self) -> f64 {
        self.slot as f64 * SLOT_S as f64
    }

    /// The values from the last `seconds`, newest last.
    pub fn last(&self, seconds: usize) -> impl ExactSizeIterator<Item = f64> + '_ {
        let skipped = self.values.len().saturating_sub(seconds / SLOT_S);
        self.values.iter().skip(skipped).map(|value| f64::from(*value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_of_each_slot_is_kept_for_eight_minutes() {
        let mut history = History::default();
        for tick in 0..10_000 {
            history.add(f64::from(tick) * 0.1, if tick % 10 == 3 { 1.0 } else { 0.1 });
        }
        assert_eq!((history.last(HISTORY_S).len(), history.last(120).len()), (120, 30));
        assert!(history.last(HISTORY_S).all(|value| value > 0.9));
    }
}
