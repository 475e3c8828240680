//! The order of the readings of each channel, and the floor on which a channel gave none.

use account::Track;
use serde::Serialize;
use std::collections::{BTreeMap, VecDeque};

/// Number of the latest readings of a channel that a reading can be out of order with.
const RECENT: usize = 256;
/// Least way without readings that is a gap: in pitches, and metres.
const GAP_PITCHES: f64 = 100.0;
const GAP_M: f64 = 0.5;
/// Largest difference of two times that are the same, seconds.
const SAME_S: f64 = 1e-9;
/// Maximum number of gaps that are kept for a channel.
const MOST_GAPS: usize = 1000;

/// The readings of every channel so far.
#[derive(Debug)]
pub(super) struct Order {
    channels: BTreeMap<u16, Channel>,
    pitch_m: f64,
    pub(super) late: u64,
    pub(super) first_late: Option<u64>,
}

#[derive(Debug, Default)]
struct Channel {
    /// Time and way of the latest readings, sorted.
    recent: VecDeque<(f64, f64)>,
    /// Time and way of the reading before these.
    before: Option<(f64, f64)>,
    lost: f64,
    gaps: Vec<(f64, f64, f64)>,
}

/// A part of the way on which channels gave no readings, although floor counted as scanned.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Gap {
    /// The channels.
    pub channels: Vec<u16>,
    /// Mission time of the last reading before it, seconds.
    pub from_s: f64,
    /// Mission time of the first reading after it, seconds.
    pub to_s: f64,
    /// The way, metres.
    pub way_m: f64,
}

/// Why a reading does not follow the others of its channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Misplaced {
    /// There is a reading of this channel at the same time.
    Duplicate,
    /// It is earlier than the latest 256 readings of its channel.
    TooLate,
}

impl Order {
    pub(super) fn new(pitch_m: f64) -> Self {
        Self { channels: BTreeMap::new(), pitch_m, late: 0, first_late: None }
    }

    /// Adds a reading of a channel; `way_m` is the way on which floor counts up to it, metres.
    pub(super) fn take(&mut self, line: u64, channel: u16, t_s: f64, way_m: f64) -> Result<(), Misplaced> {
        let of = self.channels.entry(channel).or_default();
        if of.before.is_some_and(|(before_s, _)| t_s <= before_s) {
            return Err(Misplaced::TooLate);
        }
        let place = of.recent.partition_point(|(known_s, _)| *known_s < t_s - SAME_S);
        if of.recent.get(place).is_some_and(|(known_s, _)| *known_s <= t_s + SAME_S) {
            return Err(Misplaced::Duplicate);
        }
        if place < of.recent.len() {
            self.late += 1;
            self.first_late.get_or_insert(line);
        }
        of.recent.insert(place, (t_s, way_m));
        if of.recent.len() > RECENT {
            of.leave(self.pitch_m);
        }
        Ok(())
    }

    /// Ends the readings at the end of a track. Returns the number of lost readings and the gaps, the longest way first.
    pub(super) fn finish(mut self, track: &Track, channels: u16) -> (u64, Vec<Gap>) {
        let end_s = track.span_s().map_or(0.0, |(_, end_s)| end_s);
        let end_m = track.at(end_s).map_or(0.0, |end| end.way_m);
        let (mut lost, mut all): (f64, BTreeMap<[i64; 2], Gap>) = (0.0, BTreeMap::new());
        for channel in 0..channels {
            let of = self.channels.entry(channel).or_default();
            of.recent.push_back((end_s, end_m));
            while !of.recent.is_empty() {
                of.leave(self.pitch_m);
            }
            lost += of.lost;
            for (from_s, to_s, way_m) in of.gaps.drain(..) {
                let new = Gap { channels: Vec::new(), from_s, to_s, way_m };
                let key = [from_s, to_s].map(|t_s| (10.0 * t_s).round() as i64);
                all.entry(key).or_insert(new).channels.push(channel);
            }
        }
        let mut gaps: Vec<Gap> = all.into_values().collect();
        gaps.sort_by(|a, b| b.way_m.total_cmp(&a.way_m).then(a.from_s.total_cmp(&b.from_s)));
        (lost.round() as u64, gaps)
    }
}

impl Channel {
    /// Lets the earliest of the latest readings go; no reading before it can follow.
    fn leave(&mut self, pitch_m: f64) {
        if let Some(first) = self.recent.pop_front() {
            self.pass(self.before.unwrap_or((0.0, 0.0)), first, pitch_m);
            self.before = Some(first);
        }
    }

    /// Notes the way from one reading to the next.
    fn pass(&mut self, from: (f64, f64), to: (f64, f64), pitch_m: f64) {
        let way_m = to.1 - from.1;
        self.lost += if way_m > 1.5 * pitch_m { way_m / pitch_m - 1.0 } else { 0.0 };
        if way_m > GAP_M.max(GAP_PITCHES * pitch_m) && self.gaps.len() < MOST_GAPS {
            self.gaps.push((from.0, to.0, way_m));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reading_out_of_order_is_taken_and_a_second_one_of_the_same_time_is_not() {
        let mut order = Order::new(0.01);
        for k in 0..1000_u32 {
            order.take(2, 0, f64::from(k), f64::from(k) * 0.01).unwrap();
        }
        assert_eq!(order.take(3, 0, 998.5, 9.985), Ok(()));
        assert_eq!(order.take(4, 0, 998.5, 9.985), Err(Misplaced::Duplicate));
        assert_eq!(order.take(5, 0, 998.0, 9.98), Err(Misplaced::Duplicate));
        assert_eq!(order.take(6, 0, 10.5, 0.105), Err(Misplaced::TooLate));
        assert_eq!(order.take(7, 1, 998.0, 9.98), Ok(()), "another channel");
        assert_eq!((order.late, order.first_late), (1, Some(3)));
    }
}
