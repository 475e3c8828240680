//! Offset and delay of a vehicle's clock, from the quickest round trip of the last seconds.

use super::rate::Rates;
use crate::wire::{Misfit, message::Pong};
use std::collections::VecDeque;

/// Time for which round trips are kept, seconds.
const WINDOW_S: f64 = 10.0;
/// Largest difference between the rates of two clocks, as a share.
const DRIFT: f64 = 1e-4;
/// Maximum number of round trips kept. Only trips that can still become the quickest are kept.
const KEPT_MAX: usize = 64;
/// Time by which a pong may seem to arrive before its ping was sent, because the echo is rounded, seconds.
const ROUNDING_S: f64 = 1e-3;

/// A round trip: its end, its length and the offset of the vehicle's clock, seconds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Trip {
    pub at_s: f64,
    pub took_s: f64,
    pub offset: f64,
}

/// The offset of the vehicle's clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offset {
    /// The vehicle's clock minus the console's, seconds.
    pub offset_s: f64,
    /// The greatest error of `offset_s`, seconds: half the round trip, plus the drift since then.
    pub bound_s: f64,
}

/// The clock of a vehicle.
#[derive(Debug, Clone, Default)]
pub struct Clock {
    /// The first trip is the quickest; each further trip is slower and later.
    trips: VecDeque<Trip>,
    rates: Rates,
}

impl Clock {
    /// Takes the answer to a ping.
    ///
    /// # Errors
    /// If the vehicle answers a ping that cannot have been sent.
    pub fn pong(&mut self, pong: &Pong, now_s: f64) -> Result<(), Misfit> {
        let trip_s = now_s - pong.echo_s;
        if trip_s < -ROUNDING_S {
            let what = format!("answers a ping sent at {}, but the time is only {now_s}", pong.echo_s);
            return Err(Misfit { field: "pong.echo_s".into(), what });
        }
        if trip_s > WINDOW_S {
            return Ok(());
        }
        let trip_s = trip_s.max(0.0);
        self.trips.retain(|trip| now_s - trip.at_s <= WINDOW_S);
        while self.trips.back().is_some_and(|last| last.took_s >= trip_s) {
            self.trips.pop_back();
        }
        let trip = Trip { at_s: now_s, took_s: trip_s, offset: pong.stamp_s - (now_s - trip_s / 2.0) };
        self.rates.trip(trip);
        if self.trips.len() < KEPT_MAX {
            self.trips.push_back(trip);
        }
        Ok(())
    }

    /// Takes the arrival and the stamp of readings, for the rate of the clock.
    pub fn stamp(&mut self, arrival_s: f64, stamp_s: f64) {
        self.rates.stamp(arrival_s, stamp_s);
    }

    /// The rates of the vehicle's clock.
    pub fn rates(&self) -> &Rates {
        &self.rates
    }

    /// Begins the rates again, because messages have waited in the console.
    pub(super) fn pause(&mut self) {
        self.rates.begin_again();
    }

    /// The offset now. It stays known after the last answer, but its greatest error grows.
    pub fn at(&self, now_s: f64) -> Option<Offset> {
        let recent = self.trips.iter().find(|trip| now_s - trip.at_s <= WINDOW_S);
        let trip = recent.or(self.trips.back())?;
        // The vehicle read its clock some time during the trip.
        let since_s = (now_s - trip.at_s + trip.took_s).max(0.0);
        Some(Offset { offset_s: trip.offset, bound_s: trip.took_s / 2.0 + DRIFT * since_s })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Delays of any kind on both ways, and a clock that drifts.
        #[test]
        fn the_offset_is_within_its_bound(
            delays in prop::collection::vec((0.0..0.25_f64, 0.0..0.25_f64), 1..300),
            offset_s in -1e6..1e6_f64,
            drift in -DRIFT..DRIFT,
        ) {
            let theirs = |t: f64| t * (1.0 + drift) + offset_s;
            let mut clock = Clock::default();
            for (n, (there_s, back_s)) in delays.iter().enumerate() {
                let sent_s = n as f64 * 0.1;
                let (at_vehicle_s, now_s) = (sent_s + there_s, sent_s + there_s + back_s);
                let pong = Pong { echo_s: sent_s, stamp_s: theirs(at_vehicle_s) };
                clock.pong(&pong, now_s).expect("it was sent");
                let Offset { offset_s, bound_s } = clock.at(now_s).expect("an answer");
                let error_s = offset_s - (theirs(now_s) - now_s);
                prop_assert!(error_s.abs() <= bound_s + 1e-9, "{} {}", error_s, bound_s);
                prop_assert!(clock.trips.len() <= KEPT_MAX);
            }
        }
    }

    #[test]
    fn the_quickest_answer_of_ten_seconds_counts() {
        let mut clock = Clock::default();
        let mut pong = |sent_s: f64, now_s: f64| {
            clock.pong(&Pong { echo_s: sent_s, stamp_s: 100.0 + sent_s }, now_s).expect("sent");
            clock.at(now_s).expect("an answer")
        };
        assert!((pong(0.0, 0.02).offset_s - 99.99).abs() < 1e-9);
        assert!((pong(1.0, 1.2).offset_s - 99.99).abs() < 1e-9);
        let later = pong(11.0, 11.1);
        assert!((later.offset_s - 99.95).abs() < 1e-9 && later.bound_s < 0.051, "{later:?}");
    }

    #[test]
    fn an_answer_from_the_future_is_named() {
        let answer = Clock::default().pong(&Pong { echo_s: 9.0, stamp_s: 0.0 }, 5.0);
        assert_eq!(
            answer.expect_err("a lie").to_string(),
            "pong.echo_s: answers a ping sent at 9, but the time is only 5"
        );
    }
}
