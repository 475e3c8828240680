//! One alarm and its life.

use super::Cause;
use mission::Severity;
use serde::{Deserialize, Serialize};
use std::{cmp::Ordering, collections::VecDeque};
use world::Point;

/// Events kept of an alarm, the last ones.
const MAX_EVENTS: usize = 8;

/// Where an alarm stands in its life.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum State {
    /// Its cause persists, and the operator has not seen it.
    Unacknowledged,
    /// Its cause persists, and the operator has seen it.
    Acknowledged,
    /// Its cause is gone, and the operator has not seen it.
    Returned,
    /// The operator has put it aside.
    Shelved(Shelf),
    /// Its cause is gone, and nothing is left to do.
    Cleared,
}

/// For how long an alarm is put aside, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Shelf {
    /// Mission time at which it comes back, seconds.
    pub until_s: f64,
    /// Why, in the words of the operator.
    pub reason: String,
    /// Whether its cause persists.
    pub active: bool,
}

/// The figure that an alarm is about, and its limit, with their units.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Reading {
    /// What was measured last while the cause persisted.
    pub now: String,
    /// What is allowed.
    pub limit: String,
}

/// One alarm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Alarm {
    /// What it is about.
    pub cause: Cause,
    /// How much it asks of the operator.
    pub severity: Severity,
    /// What is wrong, as a sentence.
    pub text: String,
    /// Mission time since when, seconds.
    pub since_s: f64,
    /// Where it stands in its life.
    pub state: State,
    /// The lower severity to which it has fallen since, with its words; shown once the operator has seen the worse.
    #[serde(default)]
    pub fallen: Option<(Severity, String)>,
    /// How often its cause came up.
    pub count: u32,
    /// Mission time at which its cause was last gone, seconds.
    pub cleared_s: Option<f64>,
    /// The figure that it is about, if there is one.
    pub reading: Option<Reading>,
    /// Where it is, metres, tank frame, if it is anywhere.
    pub place: Option<Point>,
    /// Numbers of its last lines in the log, oldest first.
    pub events: VecDeque<u64>,
    /// The burst of alarms that it came up in.
    pub burst: u32,
    /// Whether it was the first of that burst.
    pub is_first: bool,
}

impl Alarm {
    pub(super) fn new(cause: Cause) -> Self {
        Self {
            cause,
            severity: Severity::Info,
            text: String::new(),
            since_s: 0.0,
            state: State::Cleared,
            fallen: None,
            count: 0,
            cleared_s: None,
            reading: None,
            place: None,
            events: VecDeque::new(),
            burst: 0,
            is_first: false,
        }
    }

    /// Whether its cause persists.
    pub fn is_active(&self) -> bool {
        match &self.state {
            State::Unacknowledged | State::Acknowledged => true,
            State::Shelved(shelf) => shelf.active,
            State::Returned | State::Cleared => false,
        }
    }

    /// Whether it waits for the operator to have seen it.
    pub fn is_unacknowledged(&self) -> bool {
        matches!(self.state, State::Unacknowledged | State::Returned)
    }

    /// Whether it counts among the alarms: neither cleared nor shelved.
    pub fn is_open(&self) -> bool {
        matches!(self.state, State::Unacknowledged | State::Acknowledged | State::Returned)
    }

    /// How much it asks for the operator: the more the greater.
    pub(super) fn rank(&self) -> impl Ord + use<> {
        (self.is_unacknowledged(), self.severity, self.is_active())
    }

    /// Takes what its cause says now. What the operator has not seen is never replaced by something less severe.
    pub(super) fn take(&mut self, severity: Severity, text: String, t_s: f64) {
        // Each obstacle that is found is news of its own.
        let is_new = !self.is_active() || self.cause == Cause::Map;
        self.count = self.count.saturating_add(u32::from(is_new));
        let next = match &self.state {
            State::Shelved(shelf) if severity < Severity::Crit => {
                State::Shelved(Shelf { active: true, ..shelf.clone() })
            }
            State::Acknowledged if !is_new && severity <= self.severity => State::Acknowledged,
            _ => State::Unacknowledged,
        };
        let is_lower = self.is_unacknowledged() && severity < self.severity;
        self.state = next;
        if is_lower {
            self.fallen = Some((severity, text));
            return;
        }
        if is_new || severity > self.severity {
            self.since_s = t_s;
        }
        (self.severity, self.text, self.fallen) = (severity, text, None);
    }

    /// Notes that its cause is gone.
    pub(super) fn clear(&mut self, t_s: f64) {
        if self.is_active() {
            self.cleared_s = Some(t_s);
        }
        match &mut self.state {
            State::Unacknowledged if self.severity >= Severity::Warn => self.state = State::Returned,
            State::Unacknowledged | State::Acknowledged => self.state = State::Cleared,
            State::Shelved(shelf) => shelf.active = false,
            State::Returned | State::Cleared => {}
        }
    }

    /// Notes that the operator has seen it. The words of the lower severity were not seen, and may be about something else of
    /// the same cause: they are to be acknowledged next.
    pub(super) fn acknowledge(&mut self) {
        if let Some((severity, text)) = self.fallen.take() {
            (self.severity, self.text) = (severity, text);
            return;
        }
        match self.state {
            State::Unacknowledged => self.state = State::Acknowledged,
            State::Returned => self.state = State::Cleared,
            State::Acknowledged | State::Shelved(_) | State::Cleared => {}
        }
    }

    /// Why it cannot be put aside, if it cannot.
    pub fn cannot_be_shelved(&self) -> Option<&'static str> {
        match self.state {
            State::Returned => Some("it has cleared; <acknowledge>: acknowledge"),
            State::Cleared => Some("it has cleared"),
            _ if self.severity == Severity::Crit => Some("a CRIT alarm cannot be shelved"),
            _ => None,
        }
    }

    /// Puts it aside until some mission time, if it can be.
    pub(super) fn shelve(&mut self, until_s: f64, reason: &str) {
        if self.cannot_be_shelved().is_none() {
            self.fallen = None;
            let active = self.is_active();
            self.state = State::Shelved(Shelf { until_s, reason: reason.to_owned(), active });
        }
    }

    /// Takes it back from the shelf: nobody has seen it since.
    pub(super) fn unshelve(&mut self) {
        if let State::Shelved(shelf) = &self.state {
            self.state = if shelf.active { State::Unacknowledged } else { State::Cleared };
        }
    }

    /// Takes it back from the shelf when its time is over.
    pub(super) fn expire(&mut self, t_s: f64) {
        let is_over = |shelf: &Shelf| t_s.partial_cmp(&shelf.until_s).is_none_or(Ordering::is_ge);
        if matches!(&self.state, State::Shelved(shelf) if is_over(shelf)) {
            self.unshelve();
        }
    }

    /// Keeps the number of a line of the log that is about it.
    pub(super) fn note(&mut self, number: u64) {
        if self.events.back() == Some(&number) {
            return;
        }
        self.events.push_back(number);
        if self.events.len() > MAX_EVENTS {
            self.events.pop_front();
        }
    }
}
