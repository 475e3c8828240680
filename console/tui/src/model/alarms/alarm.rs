//! An alarm and its life cycle.

use super::Cause;
use crate::model::History;
use mission::Severity;
use serde::{Deserialize, Serialize};
use std::{cmp::Ordering, collections::VecDeque};
use world::Point;

/// How many of its most recent events are kept for an alarm.
const MAX_EVENTS: usize = 8;

/// The state of an alarm in its life cycle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum State {
    /// The cause persists, and the operator has not acknowledged the alarm.
    Unacknowledged,
    /// The cause persists, and the operator has acknowledged the alarm.
    Acknowledged,
    /// The cause is gone, and the operator has not acknowledged the alarm.
    Returned,
    /// The operator has shelved the alarm.
    Shelved(Shelf),
    /// The cause is gone, and nothing is left to do.
    Cleared,
}

/// How long an alarm is shelved, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Shelf {
    /// Mission time at which the alarm is unshelved, seconds.
    pub until_s: f64,
    /// The reason, in the operator's words.
    pub reason: String,
    /// Whether the cause persists.
    pub active: bool,
    /// The person who shelved the alarm, if known.
    #[serde(default)]
    pub by: Option<String>,
}

/// The figure that an alarm is about, and its limit.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Reading {
    /// The value, with its unit.
    pub now: String,
    /// The limit at which the alarm is raised, with its unit.
    pub limit: String,
    /// The value without sign and the limit as numbers, for a chart; `None` if the figure is not a number.
    #[serde(default)]
    pub numbers: Option<(f64, Option<f64>)>,
}

/// The acknowledgement of an alarm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Acknowledged {
    /// The person, if known.
    pub by: Option<String>,
    /// Mission time, seconds.
    pub t_s: f64,
}

/// One alarm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Alarm {
    /// The cause of the alarm.
    pub cause: Cause,
    /// The severity.
    pub severity: Severity,
    /// What is wrong, as a sentence.
    pub text: String,
    /// Mission time at which the alarm was raised, seconds.
    pub since_s: f64,
    /// Mission time at which the cause first occurred, seconds.
    #[serde(default)]
    pub first_s: f64,
    /// The alarm's state in its life cycle.
    pub state: State,
    /// The lower severity to which the alarm has dropped since it was raised, and the text for it; both are shown once
    /// the operator has acknowledged the higher severity.
    #[serde(default)]
    pub fallen: Option<(Severity, String)>,
    /// How many times the cause has occurred.
    pub count: u32,
    /// Mission time at which the cause last disappeared, seconds.
    pub cleared_s: Option<f64>,
    /// The figure that the alarm is about, if any: the last value measured while the cause persisted.
    pub reading: Option<Reading>,
    /// The worst value measured while the cause persisted.
    #[serde(default)]
    pub peak: Option<Reading>,
    /// The values of the figure without sign, also after the alarm has cleared.
    #[serde(default)]
    pub history: History,
    /// The acknowledgement since the alarm was last raised.
    #[serde(default)]
    pub acknowledged: Option<Acknowledged>,
    /// The position that the alarm is about, metres, tank frame; `None` if it has none.
    pub place: Option<Point>,
    /// Numbers of the alarm's latest log lines, oldest first.
    pub events: VecDeque<u64>,
    /// The burst of alarms to which this one belongs.
    pub burst: u32,
    /// Whether the alarm was the first of its burst.
    pub is_first: bool,
}

impl Alarm {
    pub(super) fn new(cause: Cause) -> Self {
        Self {
            cause,
            severity: Severity::Info,
            text: String::new(),
            since_s: 0.0,
            first_s: 0.0,
            state: State::Cleared,
            fallen: None,
            count: 0,
            cleared_s: None,
            reading: None,
            peak: None,
            history: History::default(),
            acknowledged: None,
            place: None,
            events: VecDeque::new(),
            burst: 0,
            is_first: false,
        }
    }

    /// Whether the cause persists.
    pub fn is_active(&self) -> bool {
        match &self.state {
            State::Unacknowledged | State::Acknowledged => true,
            State::Shelved(shelf) => shelf.active,
            State::Returned | State::Cleared => false,
        }
    }

    /// How long the cause persisted, seconds; `None` while it persists.
    pub fn lasted_s(&self) -> Option<f64> {
        self.cleared_s.filter(|_| !self.is_active()).map(|cleared_s| (cleared_s - self.since_s).max(0.0))
    }

    /// Whether the alarm awaits acknowledgement.
    pub fn is_unacknowledged(&self) -> bool {
        matches!(self.state, State::Unacknowledged | State::Returned)
    }

    /// Whether the alarm is open: neither cleared nor shelved.
    pub fn is_open(&self) -> bool {
        matches!(self.state, State::Unacknowledged | State::Acknowledged | State::Returned)
    }

    /// The urgency of the alarm; greater is more urgent. A cause that is gone is less urgent than one that persists,
    /// and more urgent than a WATCH alarm.
    pub(super) fn rank(&self) -> impl Ord + use<> {
        (self.is_unacknowledged(), self.severity >= Severity::Warn, self.is_active(), self.severity)
    }

    /// Updates the alarm with the latest severity and text of its cause. An unacknowledged text is never replaced by
    /// a less severe one.
    pub(super) fn take(&mut self, severity: Severity, text: String, t_s: f64) {
        // Each new obstacle is a separate alarm condition.
        let is_new = !self.is_active() || self.cause == Cause::Map;
        if self.count == 0 {
            self.first_s = t_s;
        }
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
        if self.is_unacknowledged() {
            self.acknowledged = None;
        }
        if is_lower {
            self.fallen = Some((severity, text));
            return;
        }
        if is_new || severity > self.severity {
            self.since_s = t_s;
        }
        (self.severity, self.text, self.fallen) = (severity, text, None);
    }

    /// Records that the cause is gone.
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

    /// Takes the latest value of the alarm's figure.
    pub(super) fn read(&mut self, reading: Reading, t_s: f64) {
        if let Some((value, _)) = reading.numbers {
            self.history.add(t_s, value);
        }
        if !self.is_active() {
            return;
        }
        let value = |reading: &Reading| reading.numbers.map_or(f64::NEG_INFINITY, |(value, _)| value);
        if self.peak.as_ref().is_none_or(|peak| value(peak) <= value(&reading)) {
            self.peak = Some(reading.clone());
        }
        self.reading = Some(reading);
    }

    /// Records the operator's acknowledgement. If the alarm has since dropped to a lower severity, the text for that
    /// severity was not on the screen and may be about something else with the same cause; the operator must
    /// acknowledge it next.
    pub(super) fn acknowledge(&mut self, by: Option<&str>, t_s: f64) {
        if let Some((severity, text)) = self.fallen.take() {
            (self.severity, self.text) = (severity, text);
            return;
        }
        if self.is_unacknowledged() {
            self.acknowledged = Some(Acknowledged { by: by.map(str::to_owned), t_s });
        }
        match self.state {
            State::Unacknowledged => self.state = State::Acknowledged,
            State::Returned => self.state = State::Cleared,
            State::Acknowledged | State::Shelved(_) | State::Cleared => {}
        }
    }

    /// Why the alarm cannot be shelved; `None` if it can.
    pub fn cannot_be_shelved(&self) -> Option<&'static str> {
        match self.state {
            State::Returned => Some("cleared alarms are acknowledged (<acknowledge>), not shelved"),
            State::Cleared => Some("not shelved: the alarm has cleared"),
            _ if self.severity == Severity::Crit => Some("a CRIT alarm cannot be shelved"),
            _ => None,
        }
    }

    /// Shelves the alarm until the given mission time, if shelving is allowed.
    pub(super) fn shelve(&mut self, until_s: f64, reason: &str, by: Option<&str>) {
        if self.cannot_be_shelved().is_none() {
            self.fallen = None;
            let (active, by) = (self.is_active(), by.map(str::to_owned));
            self.state = State::Shelved(Shelf { until_s, reason: reason.to_owned(), active, by });
        }
    }

    /// Unshelves the alarm, which becomes unacknowledged again.
    pub(super) fn unshelve(&mut self) {
        if let State::Shelved(shelf) = &self.state {
            self.state = if shelf.active { State::Unacknowledged } else { State::Cleared };
        }
    }

    /// Unshelves the alarm when its time is up.
    pub(super) fn expire(&mut self, t_s: f64) {
        let is_over = |shelf: &Shelf| t_s.partial_cmp(&shelf.until_s).is_none_or(Ordering::is_ge);
        if matches!(&self.state, State::Shelved(shelf) if is_over(shelf)) {
            self.unshelve();
        }
    }

    /// Records the number of a log line that is about the alarm.
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
