//! The state of the link to a vehicle, from the stamps of its messages. All times come from outside: `now_s` is the
//! time of the console's clock, which also stamps its commands.
//!
//! [`Link`] folds received and sent messages; its parts can also be used alone: [`Clock`] (offset and delay),
//! [`Sequence`] (loss), [`Motions`] (motion from odometry or poses), [`Stopping`] (whether the vehicle stands still),
//! [`Comparison`] (whether it moves as commanded).

mod clock;
mod compare;
mod motion;
mod rate;
mod sequence;
mod stopping;
#[cfg(test)]
mod tests;

pub use clock::{Clock, Offset};
pub use compare::{Axis, Comparison, Finding};
pub use motion::Motions;
pub use rate::{RATE_OFF, Rates, is_off};
pub use sequence::{Counts, Sequence};
pub use stopping::{Hold, Stopping};

use crate::wire::{
    FAULT_AFTER, FromVehicle, Heard,
    message::{Drive, Hello, Readings, Stop},
};

/// Age above which readings are late, seconds.
const LATE_S: f64 = 0.4;
/// Age of the newest readings above which the link is lost, seconds. The loss of a tenth of the messages, with a jitter
/// of 200 ms, does not reach this age; the screen still shows a lost link within a second.
const LOST_S: f64 = 0.8;
/// The same two limits in periods of the readings; they apply if readings are slow.
const LATE_PERIODS: f64 = 2.0;
const LOST_PERIODS: f64 = 3.0;
/// Time without an answer to a ping, seconds, after which a vehicle that has answered pings before counts as not
/// receiving commands. It is longer than ten pings and their answers take, because a network may lose some of them.
const DEAF_S: f64 = 2.0;
/// Messages per second above which the link is faulty: this multiple of the rate of readings, plus a fixed number for
/// other messages.
const FLOOD_FACTOR: f64 = 10.0;
const FLOOD_SLACK: f64 = 100.0;

/// The state of a link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// The vehicle has not introduced itself yet, or has not sent readings.
    Connecting,
    /// Readings arrive in time.
    Alive,
    /// The last readings are too old, but not yet so old that the link counts as lost.
    Late,
    /// The connection has ended, the last readings are too old, or the vehicle does not answer. It stops by its lease.
    Lost,
    /// The vehicle cannot be trusted until it connects again.
    Fault,
}

/// A link to a vehicle.
#[derive(Debug, Clone, Default)]
pub struct Link {
    hello: Option<Hello>,
    clock: Clock,
    sequence: Sequence,
    motions: Motions,
    stopping: Stopping,
    comparison: Comparison,
    /// Arrival and stamp of the newest readings.
    newest: Option<(f64, f64)>,
    last_drive: Option<Drive>,
    /// Whether pings are sent, and the time of sending of the newest one that was answered.
    pings: bool,
    answered_s: Option<f64>,
    closed: bool,
    /// End of the last time in which the console itself was stopped, seconds.
    resumed_s: Option<f64>,
    fault: Option<String>,
    malformed_in_row: u32,
    /// Arrival of the last line, seconds.
    heard_s: f64,
    /// Start of the current second, the number of lines received in it, and the silence before it, seconds.
    second: (f64, u32, f64),
}

impl Link {
    /// Takes a received line.
    pub fn heard(&mut self, heard: &Heard<FromVehicle>, now_s: f64) {
        self.count(now_s);
        match heard {
            Heard::Message(message) => {
                // A vehicle may answer pings although it sends readings that cannot be used.
                if matches!(message, FromVehicle::Readings(_) | FromVehicle::Hello(_)) {
                    self.malformed_in_row = 0;
                }
                self.message(message, now_s);
            }
            Heard::Malformed(misfit) => {
                self.malformed_in_row += 1;
                if self.malformed_in_row >= FAULT_AFTER {
                    self.fault.get_or_insert_with(|| {
                        format!("{FAULT_AFTER} malformed lines without good readings in between; {misfit}")
                    });
                }
            }
            Heard::Unknown(_) => {}
        }
    }

    /// Counts a line. After a silence, as many lines more may arrive in a second as the vehicle may have sent meanwhile: a
    /// console that was stopped for a minute finds them all at once.
    fn count(&mut self, now_s: f64) {
        let (start_s, n, silent_s) = self.second;
        let waited_s = now_s - std::mem::replace(&mut self.heard_s, now_s);
        let goes_on = now_s - start_s < 1.0;
        self.second = if goes_on { (start_s, n.saturating_add(1), silent_s) } else { (now_s, 1, waited_s) };
        let Some(hello) = &self.hello else { return };
        let most = FLOOD_FACTOR / hello.period_s + FLOOD_SLACK;
        let (_, n, silent_s) = self.second;
        if f64::from(n) > most * silent_s.max(1.0) {
            self.fault.get_or_insert_with(|| format!("more than {most:.0} messages in a second"));
        }
    }

    fn message(&mut self, message: &FromVehicle, now_s: f64) {
        match message {
            FromVehicle::Hello(hello) => {
                // The vehicle has started again: only a fault and the counts are kept from before.
                let mut sequence = std::mem::take(&mut self.sequence);
                sequence.restart();
                let fault = self.fault.take();
                *self = Self { hello: Some(hello.as_ref().clone()), fault, sequence, ..Self::default() };
                (self.heard_s, self.second) = (now_s, (now_s, 1, 0.0));
            }
            FromVehicle::Readings(readings) => self.readings(readings, now_s),
            FromVehicle::Pong(pong) => {
                if let Err(misfit) = self.clock.pong(pong, now_s) {
                    self.fault.get_or_insert_with(|| misfit.to_string());
                } else {
                    self.answered_s = Some(self.answered_s.map_or(pong.echo_s, |s| s.max(pong.echo_s)));
                }
            }
            FromVehicle::State(_) => {}
        }
    }

    fn readings(&mut self, readings: &Readings, now_s: f64) {
        if !self.sequence.add(readings.seq) {
            // A late or duplicate message: its motion is part of later readings, or cannot be put in order.
            return;
        }
        self.newest = Some((now_s, readings.stamp_s));
        self.clock.stamp(now_s, readings.stamp_s);
        let Some(motion) = self.motions.take(readings) else { return };
        // The earliest time at which the readings can have been taken.
        let taken_s = self.clock.at(now_s).map(|offset| readings.stamp_s - offset.offset_s - offset.bound_s);
        let taken_s = taken_s.unwrap_or(now_s).min(now_s);
        if self.may_move_until_s(now_s).is_none_or(|until_s| taken_s > until_s) {
            self.comparison.command(None);
        }
        self.stopping.moved(&motion, taken_s);
        if let Some(hello) = &self.hello {
            self.comparison.moved(&motion, &hello.limits);
        }
    }

    /// A drive was sent.
    pub fn drove(&mut self, drive: &Drive) {
        self.last_drive = Some(*drive);
        self.stopping.release();
        self.comparison.command(Some(drive));
    }

    /// A stop was commanded, and will be sent as soon as the stream takes it.
    pub fn must_stand(&mut self, now_s: f64) {
        self.stopping.ask(now_s);
    }

    /// A stop was sent, again or for the first time.
    pub fn stopped(&mut self, stop: &Stop) {
        self.stopping.ask(stop.stamp_s);
        self.stopping.sent(stop.stamp_s);
        self.comparison.command(None);
    }

    /// A ping was sent.
    pub fn pinged(&mut self) {
        self.pings = true;
    }

    /// Whether the vehicle has stopped answering; commands may then be waiting on their way to it.
    pub fn is_deaf(&self, now_s: f64) -> bool {
        let answered_s = self.answered_s.map(|s| self.resumed_s.map_or(s, |resumed_s| s.max(resumed_s)));
        self.pings && answered_s.is_some_and(|answered_s| now_s - answered_s > DEAF_S)
    }

    /// The console itself was stopped until now: messages of the vehicle may wait to be read, and its silence begins now.
    pub fn resumed(&mut self, now_s: f64) {
        self.resumed_s = Some(now_s);
        self.clock.pause();
    }

    /// The connection has ended.
    pub fn closed(&mut self) {
        self.closed = true;
    }

    /// The state of the link.
    pub fn state(&self, now_s: f64) -> State {
        if self.closed {
            return State::Lost;
        }
        if self.fault.is_some() {
            return State::Fault;
        }
        let (Some(hello), Some(age_s)) = (&self.hello, self.age_s(now_s)) else { return State::Connecting };
        let lost_s = LOST_S.max(LOST_PERIODS * hello.period_s);
        let is_reading = self.resumed_s.is_some_and(|resumed_s| now_s - resumed_s <= lost_s);
        if (age_s > lost_s && !is_reading) || self.is_deaf(now_s) {
            State::Lost
        } else if age_s > LATE_S.max(LATE_PERIODS * hello.period_s) {
            State::Late
        } else {
            State::Alive
        }
    }

    /// The reason why the link is faulty; the first one counts.
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// Age of the newest readings, seconds: since their arrival or, if that is longer and the clock offset is known,
    /// since the latest time at which they can have been measured.
    pub fn age_s(&self, now_s: f64) -> Option<f64> {
        let (arrival_s, stamp_s) = self.newest?;
        let measured =
            self.clock.at(now_s).map(|offset| now_s - (stamp_s - offset.offset_s) - offset.bound_s);
        Some(measured.unwrap_or(0.0).max(now_s - arrival_s))
    }

    /// The time until which the vehicle may carry out the last drive, seconds of the console's clock: time of sending
    /// plus quickest round trip plus lease. After that and its stop time, a vehicle that keeps its lease stands still,
    /// but only readings can confirm this.
    pub fn may_move_until_s(&self, now_s: f64) -> Option<f64> {
        let drive = self.last_drive?;
        let way_s = self.clock.at(now_s).map_or(0.0, |offset| 2.0 * offset.bound_s);
        Some(drive.stamp_s + way_s + drive.lease_s)
    }

    /// Whether the vehicle stands still after a stop.
    pub fn hold(&self, now_s: f64) -> Hold {
        let Some(hello) = &self.hello else { return Hold::NotAsked };
        let trip_s = self.clock.at(now_s).map_or(0.0, |offset| 2.0 * offset.bound_s);
        self.stopping.state(now_s, Stopping::limit_s(hello, trip_s))
    }

    /// Time at which the vehicle was commanded to stand still, seconds; `None` while it may drive.
    pub fn asked_to_stand_s(&self) -> Option<f64> {
        self.stopping.asked_s()
    }

    /// The difference between commands and motion, if any.
    pub fn finding(&self) -> Option<Finding> {
        self.comparison.finding()
    }

    /// Offset and delay of the vehicle's clock.
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// Time since the arrival of the newest readings, seconds.
    pub fn silent_s(&self, now_s: f64) -> Option<f64> {
        self.newest.map(|(arrival_s, _)| now_s - arrival_s)
    }

    /// The numbers of lost, duplicate and reordered readings.
    pub fn counts(&self) -> Counts {
        self.sequence.counts()
    }
}
