//! The rate of a vehicle's clock, in seconds for each second of the console's clock.

use super::clock::Trip;

/// Shortest time over which a rate is measured, seconds.
const OVER_S: f64 = 10.0;
/// Largest difference from 1 of the rate of a good clock.
pub const RATE_OFF: f64 = 0.01;
/// Largest error with which a rate by pings is used.
const ERROR_MAX: f64 = RATE_OFF / 2.0;
/// Time, seconds, within which a quicker round trip replaces the first one.
const BETTER_WITHIN_S: f64 = 1.0;

/// The rates of the clocks behind both kinds of stamps; they may differ, for example if a sensor has its own clock.
#[derive(Debug, Clone, Default)]
pub struct Rates {
    trip: Option<Trip>,
    by_pings: Option<f64>,
    window: Option<Window>,
    /// The rates of the last two windows, the later one first.
    by_stamps: [Option<f64>; 2],
}

impl Rates {
    /// Takes a round trip. The vehicle read its clock some time during the trip, so the error of a rate is known.
    pub(super) fn trip(&mut self, trip: Trip) {
        let Some(first) = self.trip else {
            self.trip = Some(trip);
            return;
        };
        let over_s = trip.at_s - first.at_s;
        if over_s < BETTER_WITHIN_S && trip.took_s < first.took_s {
            self.trip = Some(trip);
        }
        let error = f64::midpoint(trip.took_s, first.took_s) / over_s;
        if over_s >= OVER_S && error <= ERROR_MAX {
            let between_s = over_s - (trip.took_s - first.took_s) / 2.0;
            self.by_pings = Some(1.0 + (trip.offset - first.offset) / between_s);
            self.trip = Some(trip);
        }
    }

    /// Takes the arrival and the stamp of readings, seconds.
    pub fn stamp(&mut self, arrival_s: f64, stamp_s: f64) {
        let window = self.window.get_or_insert(Window { from: (arrival_s, stamp_s), ..Window::default() });
        window.add(arrival_s, stamp_s);
        if arrival_s - window.from.0 >= OVER_S {
            self.by_stamps = [window.slope(), self.by_stamps[0]];
            self.window = None;
        }
    }

    /// Begins again after a time in which messages waited in the console.
    pub(super) fn begin_again(&mut self) {
        (self.trip, self.window) = (None, None);
    }

    /// The rate by the answers to pings.
    pub fn by_pings(&self) -> Option<f64> {
        self.by_pings
    }

    /// The rate by the stamps of the readings in the last 10 s. Readings that waited on their way can change it.
    pub fn by_stamps(&self) -> Option<f64> {
        self.by_stamps[0]
    }

    /// The field and the rate of a clock whose rate is known and differs from the console's by more than 1 %; otherwise a
    /// known rate. Stamps of readings count only if two windows in a row agree.
    pub fn worst(&self) -> Option<(&'static str, f64)> {
        let steady = match self.by_stamps {
            [Some(one), Some(other)] => {
                Some(if (one - 1.0).abs() < (other - 1.0).abs() { one } else { other })
                    .filter(|_| (one > 1.0) == (other > 1.0))
            }
            _ => None,
        };
        let pings = self.by_pings.map(|rate| ("pong.stamp_s", rate));
        let stamps = steady.map(|rate| ("readings.stamp_s", rate));
        pings
            .filter(|(_, rate)| is_off(*rate))
            .or(stamps.filter(|(_, rate)| is_off(*rate)))
            .or(pings)
            .or(stamps)
    }
}

/// Whether a rate differs from that of the console's clock by more than 1 %.
pub fn is_off(rate: f64) -> bool {
    (rate - 1.0).abs() > RATE_OFF
}

/// Sums for the line through arrivals and stamps, relative to the first ones.
#[derive(Debug, Clone, Default)]
struct Window {
    from: (f64, f64),
    n: f64,
    t: f64,
    s: f64,
    tt: f64,
    ts: f64,
}

impl Window {
    fn add(&mut self, arrival_s: f64, stamp_s: f64) {
        let (t, s) = (arrival_s - self.from.0, stamp_s - self.from.1);
        self.n += 1.0;
        (self.t, self.s, self.tt, self.ts) = (self.t + t, self.s + s, self.tt + t * t, self.ts + t * s);
    }

    fn slope(&self) -> Option<f64> {
        let spread = self.n * self.tt - self.t * self.t;
        (spread > 0.0).then(|| (self.n * self.ts - self.t * self.s) / spread)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Pings and readings every 50 ms for 45 s, with these delays on both ways.
    fn rates(delays: &[(f64, f64)], rates: [f64; 2]) -> Rates {
        let mut found = Rates::default();
        for n in 0..900_u32 {
            let (there_s, back_s) = delays[n as usize % delays.len()];
            let sent_s = 0.05 * f64::from(n);
            let (at_vehicle_s, at_s) = (sent_s + there_s, sent_s + there_s + back_s);
            let took_s = at_s - sent_s;
            found.trip(Trip {
                at_s,
                took_s,
                offset: 500.0 + at_vehicle_s * rates[0] - (at_s - took_s / 2.0),
            });
            found.stamp(at_s, 500.0 + at_vehicle_s * rates[1]);
        }
        found
    }

    proptest! {
        #[test]
        fn a_clock_is_named_if_and_only_if_its_rate_is_off(
            delays in prop::collection::vec((0.0..0.05_f64, 0.0..0.05_f64), 1..50),
            pings in prop::sample::select(vec![0.8, 0.98, 1.0, 1.0001, 1.02, 1.2]),
            stamps in prop::sample::select(vec![0.8, 0.98, 1.0, 1.0001, 1.02, 1.2]),
        ) {
            let found = rates(&delays, [pings, stamps]).worst().filter(|(_, rate)| is_off(*rate));
            let expected = if is_off(pings) {
                Some(("pong.stamp_s", pings))
            } else {
                is_off(stamps).then_some(("readings.stamp_s", stamps))
            };
            prop_assert_eq!(found.map(|(field, _)| field), expected.map(|(field, _)| field));
            if let (Some((_, found)), Some((_, is))) = (found, expected) {
                prop_assert!((found - is).abs() < 0.01, "{} {}", found, is);
            }
        }
    }

    #[test]
    fn readings_that_waited_once_do_not_blame_the_clock() {
        let mut found = Rates::default();
        for n in 0..1200_u32 {
            let taken_s = 0.05 * f64::from(n);
            // For four seconds, nothing arrives.
            let arrival_s = if (18.0..22.0).contains(&taken_s) { 22.0 } else { taken_s + 0.01 };
            found.stamp(arrival_s, taken_s);
            assert!(found.worst().is_none_or(|(_, rate)| !is_off(rate)), "{taken_s} {found:?}");
        }
    }
}
