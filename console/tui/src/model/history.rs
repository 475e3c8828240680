//! The values over the last minutes, for curves.

use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The mission time covered by a history, seconds.
pub const HISTORY_S: usize = 480;
/// The length of a slot, seconds of mission time. Only the largest value in a slot is kept, so a curve moves at most
/// once per slot.
pub const SLOT_S: usize = 4;

/// The number of slots kept.
const KEPT: usize = HISTORY_S / SLOT_S;

/// The spans of curves, seconds; a curve covers the shortest one that holds everything since the start of the mission.
const SPANS_S: [usize; 4] = [60, 120, 240, HISTORY_S];
/// A curve that no longer begins at the start of the mission shifts by this part of its span.
const SHIFTS: f64 = 8.0;

/// The largest value in each slot of [`SLOT_S`] seconds of mission time over the last [`HISTORY_S`] seconds, newest
/// last. A slot without a value, such as one while the robot was held, is empty.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct History {
    values: VecDeque<Option<f32>>,
    slot: u64,
}

/// The next shorter or longer span of curves, seconds; the same one if it is the last.
pub(crate) fn stepped_span_s(span_s: usize, longer: bool) -> usize {
    let at = SPANS_S.iter().position(|known| *known == span_s).unwrap_or(SPANS_S.len() - 1);
    let at = if longer { (at + 1).min(SPANS_S.len() - 1) } else { at.saturating_sub(1) };
    SPANS_S[at]
}

impl History {
    /// Adds a value at a mission time, seconds; times do not decrease.
    pub fn add(&mut self, t_s: f64, value: f64) {
        let slot = t_s.max(0.0) as u64 / SLOT_S as u64;
        let value = value as f32;
        match self.values.back_mut() {
            Some(last) if slot <= self.slot => {
                *last = Some(last.map_or(value, |before| before.max(value)));
                return;
            }
            Some(_) => self.leave_empty(slot - self.slot - 1),
            None => {}
        }
        self.push(Some(value));
        self.slot = slot;
    }

    /// Adds empty slots, at most as many as are kept.
    fn leave_empty(&mut self, slots: u64) {
        (0..slots.min(KEPT as u64)).for_each(|_| self.push(None));
    }

    fn push(&mut self, value: Option<f32>) {
        self.values.push_back(value);
        if self.values.len() > KEPT {
            self.values.pop_front();
        }
    }

    /// Mission time at which the newest slot begins, seconds.
    pub fn newest_s(&self) -> f64 {
        self.slot as f64 * SLOT_S as f64
    }

    /// The mission time that a curve of at most `most_s` seconds covers: its beginning and its end, seconds. It begins
    /// at the start of the mission until that is too long ago. It changes rarely, so that most frames differ little.
    pub fn span_s(&self, most_s: usize) -> [f64; 2] {
        let end_s = self.newest_s() + SLOT_S as f64;
        let spans = SPANS_S.into_iter().filter(|span_s| *span_s <= most_s).map(|span_s| span_s as f64);
        if let Some(span_s) = spans.into_iter().find(|span_s| end_s <= *span_s) {
            return [0.0, span_s];
        }
        let shift_s = most_s as f64 / SHIFTS;
        let to_s = (end_s / shift_s).ceil() * shift_s;
        [to_s - most_s as f64, to_s]
    }

    /// The mission time at which each slot from `from_s` on begins, seconds, and its value, `None` if it is empty;
    /// newest last.
    pub fn since(&self, from_s: f64) -> impl Iterator<Item = (f64, Option<f64>)> + '_ {
        let (newest_s, last) = (self.newest_s(), self.values.len().saturating_sub(1));
        let values = self.values.iter().enumerate();
        let timed = values
            .map(move |(index, value)| (newest_s - ((last - index) * SLOT_S) as f64, value.map(f64::from)));
        timed.filter(move |(t_s, _)| *t_s >= from_s)
    }

    /// The values from the last `seconds`, newest last; empty slots are left out.
    pub fn last(&self, seconds: usize) -> impl Iterator<Item = f64> + '_ {
        let skipped = self.values.len().saturating_sub(seconds / SLOT_S);
        self.values.iter().skip(skipped).flatten().map(|value| f64::from(*value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_begins_at_the_start_of_the_mission_until_it_is_full() {
        let at = |t_s: f64| {
            let mut history = History::default();
            history.add(0.0, 1.0);
            history.add(t_s, 2.0);
            history.span_s(HISTORY_S)
        };
        let spans = [0.0, 50.0, 60.0, 130.0, 470.0, 480.0, 965.0].map(at);
        let expected = [
            [0.0, 60.0],
            [0.0, 60.0],
            [0.0, 120.0],
            [0.0, 240.0],
            [0.0, 480.0],
            [60.0, 540.0],
            [540.0, 1020.0],
        ];
        assert_eq!(spans, expected);
    }

    #[test]
    fn the_worst_of_each_slot_is_kept_for_eight_minutes() {
        let mut history = History::default();
        for tick in 0..10_000 {
            history.add(f64::from(tick) * 0.1, if tick % 10 == 3 { 1.0 } else { 0.1 });
        }
        assert_eq!((history.last(HISTORY_S).count(), history.last(120).count()), (120, 30));
        assert!(history.last(HISTORY_S).all(|value| value > 0.9));
    }

    #[test]
    fn values_before_a_hold_keep_their_times() {
        let mut history = History::default();
        for (t_s, value) in [(0.0, 1.0), (4.0, 2.0), (304.0, 3.0)] {
            history.add(t_s, value);
        }
        let known = |history: &History| {
            history.since(0.0).filter_map(|(t_s, value)| Some((t_s, value?))).collect::<Vec<_>>()
        };
        assert_eq!(known(&history), [(0.0, 1.0), (4.0, 2.0), (304.0, 3.0)]);
        assert_eq!(history.since(0.0).count(), 77, "the slots of the hold are empty");
        history.add(1e12, 4.0);
        assert_eq!(known(&history).len(), 1);
        assert_eq!(history.since(0.0).count(), KEPT, "a long gap takes no more room");
    }
}
