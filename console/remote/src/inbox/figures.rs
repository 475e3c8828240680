//! Figures of a link: the offset of the vehicle's clock, and the age of its readings.

use std::collections::VecDeque;
use vehicle::wire::message::Pong;

/// The offset follows from the quickest answer within this time, seconds.
const WINDOW_S: f64 = 10.0;
/// Answers and ages that are kept.
const MOST_PONGS: usize = 64;
const MOST_AGES: usize = 1024;

/// The offset between the vehicle's clock and the console's.
#[derive(Debug, Default)]
pub(super) struct ClockOffset {
    /// Arrival, round trip and offset, seconds.
    pongs: VecDeque<(f64, f64, f64)>,
}

impl ClockOffset {
    pub(super) fn pong(&mut self, pong: Pong, now_s: f64) {
        let trip_s = now_s - pong.echo_s;
        // An echo from the future, or one that nobody asked for.
        if !(0.0..=WINDOW_S).contains(&trip_s) {
            return;
        }
        self.pongs.retain(|(at_s, ..)| now_s - at_s <= WINDOW_S);
        if self.pongs.len() == MOST_PONGS {
            self.pongs.pop_front();
        }
        self.pongs.push_back((now_s, trip_s, pong.stamp_s - (pong.echo_s + trip_s / 2.0)));
    }

    fn best(&self) -> Option<(f64, f64)> {
        let quickest = self.pongs.iter().min_by(|one, other| one.1.total_cmp(&other.1));
        quickest.map(|(_, trip_s, offset_s)| (*trip_s, *offset_s))
    }

    /// The vehicle's clock minus the console's, seconds.
    pub(super) fn offset_s(&self) -> Option<f64> {
        self.best().map(|(_, offset_s)| offset_s)
    }

    /// The bound on the error of the offset, seconds.
    pub(super) fn bound_s(&self) -> Option<f64> {
        self.best().map(|(trip_s, _)| trip_s / 2.0)
    }

    /// The age of a reading with this stamp, seconds.
    pub(super) fn age_s(&self, stamp_s: f64, now_s: f64) -> Option<f64> {
        self.offset_s().map(|offset_s| (now_s - (stamp_s - offset_s)).max(0.0))
    }
}

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
