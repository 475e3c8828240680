//! The alarms of a run.

use super::alarm::{Alarm, Reading, State};
use super::cause::Cause;
use super::delayed::{Delayed, Next};
use super::rule::Rule;
use mission::{Note, Noted, Severity};
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;
use world::Point;

/// The maximum number of alarms kept; there are fewer causes than that.
const MAX_ALARMS: usize = 64;
/// An alarm more than this long after the previous one begins a new burst, seconds of mission time. The consequences
/// of a failure follow within a few ranging cycles and hold times.
const BURST_S: f64 = 10.0;

/// The alarms of a run, in the order in which they first occurred.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Alarms {
    list: Vec<Alarm>,
    bursts: u32,
    /// Mission time at which the first cause of the current burst began, seconds.
    #[serde(default)]
    began_s: f64,
    last_s: Option<f64>,
    /// Causes that wait for their delay, in the order in which they began to wait.
    #[serde(default)]
    delayed: Vec<Delayed>,
}

impl Alarms {
    /// Takes a cause that has occurred. The alarm is raised after the delay of the rule, if the cause persists until
    /// then.
    pub fn occurred(&mut self, cause: Cause, rule: Rule, text: String, t_s: f64) {
        let Rule { severity, on_delay_s, .. } = rule;
        let is_active = self.get(&cause).is_some_and(Alarm::is_active);
        let began = self.forget_delayed(&cause).filter(|delayed| delayed.next != Next::Clear);
        if is_active || on_delay_s <= 0.0 {
            self.raise(cause, severity, text, t_s);
            return;
        }
        let since_s = began.as_ref().map_or(t_s, |began| began.since_s);
        let (line, readings) = match began.map(|began| began.next) {
            Some(Next::Raise { line, readings, .. }) => (line, readings),
            _ => (None, Vec::new()),
        };
        let next = Next::Raise { severity, text, line, readings };
        self.delayed.push(Delayed { cause, next, since_s, delay_s: on_delay_s });
    }

    /// Takes the end of a cause. The alarm clears after the given delay, seconds, unless the cause occurs again before
    /// then.
    pub fn passed(&mut self, cause: &Cause, off_delay_s: f64, t_s: f64) {
        let began = self.forget_delayed(cause).filter(|delayed| delayed.next == Next::Clear);
        if off_delay_s <= 0.0 {
            self.clear(cause, t_s);
        } else if self.get(cause).is_some_and(Alarm::is_active) {
            let since_s = began.map_or(t_s, |began| began.since_s);
            let (cause, next) = (cause.clone(), Next::Clear);
            self.delayed.push(Delayed { cause, next, since_s, delay_s: off_delay_s });
        }
    }

    /// Raises the alarm of a persisting cause with at least the given severity, without any further delay: the robot is
    /// held for it.
    pub fn holds(&mut self, cause: &Cause, severity: Severity, t_s: f64) {
        let text = match self.delayed.iter().find(|delayed| delayed.cause == *cause) {
            Some(Delayed { next: Next::Raise { text, .. }, .. }) => Some(text.clone()),
            _ => self.get(cause).filter(|alarm| alarm.is_active()).map(|alarm| alarm.text.clone()),
        };
        if let Some(text) = text {
            self.release(cause, severity, text, t_s);
        }
    }

    /// Raises and clears the alarms whose delays are over.
    fn settle(&mut self, t_s: f64) {
        self.settle_those(t_s, |delayed| delayed.is_due(t_s));
    }

    /// Raises and clears all alarms that wait: the run has ended, so their causes do not change any more.
    pub fn conclude(&mut self, t_s: f64) {
        self.settle_those(t_s, |_| true);
    }

    fn settle_those(&mut self, t_s: f64, is_due: impl Fn(&Delayed) -> bool) {
        while let Some(at) = self.delayed.iter().position(&is_due) {
            let Delayed { cause, next, .. } = self.delayed[at].clone();
            match next {
                Next::Raise { severity, text, .. } => self.release(&cause, severity, text, t_s),
                Next::Clear => {
                    self.delayed.remove(at);
                    self.clear(&cause, t_s);
                }
            }
        }
    }

    /// Raises an alarm that has waited, with its log line and the time at which its cause began.
    fn release(&mut self, cause: &Cause, severity: Severity, text: String, t_s: f64) {
        let delayed = self.forget_delayed(cause);
        let since_s = delayed.as_ref().map_or(t_s, |delayed| delayed.since_s);
        self.raise(cause.clone(), severity, text, since_s);
        let Some(Delayed { next: Next::Raise { line, readings, .. }, .. }) = delayed else { return };
        if let Some((number, place)) = line {
            self.note(cause, number, place);
        }
        for (t_s, reading) in readings {
            self.read(cause, t_s, || reading);
        }
    }

    /// The pending change of the alarm of a cause that waits.
    fn waiting(&mut self, cause: &Cause) -> Option<&mut Next> {
        self.delayed.iter_mut().find(|delayed| delayed.cause == *cause).map(|delayed| &mut delayed.next)
    }

    fn forget_delayed(&mut self, cause: &Cause) -> Option<Delayed> {
        let at = self.delayed.iter().position(|delayed| delayed.cause == *cause)?;
        Some(self.delayed.remove(at))
    }

    /// Raises an alarm. If the alarm is already active, it takes the new text; it needs another acknowledgement only
    /// if its severity has risen.
    pub fn raise(&mut self, cause: Cause, severity: Severity, text: String, t_s: f64) {
        let Some(index) = self.place_of(cause) else { return };
        if !self.list[index].is_active() {
            self.join_burst(index, t_s);
        }
        self.list[index].take(severity, text, t_s);
    }

    /// Changes the text of an alarm; its state stays as it is.
    pub fn reword(&mut self, cause: &Cause, text: impl FnOnce(&str) -> String) {
        if let Some(alarm) = self.list.iter_mut().find(|alarm| alarm.cause == *cause) {
            alarm.text = text(&alarm.text);
        }
    }

    /// The index of the alarm of a cause. If the list is full, a new alarm replaces one that cleared long ago.
    fn place_of(&mut self, cause: Cause) -> Option<usize> {
        if let Some(index) = self.list.iter().position(|alarm| alarm.cause == cause) {
            return Some(index);
        }
        if self.list.len() >= MAX_ALARMS {
            let oldest = self.list.iter().position(|alarm| alarm.state == State::Cleared)?;
            self.list.remove(oldest);
        }
        self.list.push(Alarm::new(cause));
        Some(self.list.len() - 1)
    }

    /// Adds an alarm to the current burst, or begins a new one. The alarm whose cause began first is the first of the
    /// burst, even if it was raised later because of its delay.
    fn join_burst(&mut self, index: usize, t_s: f64) {
        let is_new = self.last_s.is_none_or(|last_s| t_s - last_s > BURST_S);
        let is_first = is_new || t_s < self.began_s;
        self.last_s = Some(self.last_s.map_or(t_s, |last_s| last_s.max(t_s)));
        self.bursts += u32::from(is_new);
        if is_first {
            self.began_s = t_s;
            let burst = self.bursts;
            self.list
                .iter_mut()
                .filter(|alarm| alarm.burst == burst)
                .for_each(|alarm| alarm.is_first = false);
        }
        let alarm = &mut self.list[index];
        if is_first || alarm.burst != self.bursts {
            (alarm.burst, alarm.is_first) = (self.bursts, is_first);
        }
    }

    /// Records that a cause is gone.
    pub fn clear(&mut self, cause: &Cause, t_s: f64) {
        if let Some(alarm) = self.get_mut(cause) {
            alarm.clear(t_s);
        }
    }

    /// Applies the operator's action on an alarm. An acknowledgement applies only to the text that the operator saw.
    pub fn take(&mut self, Note { what: noted, by }: &Note, t_s: f64) {
        let by = by.as_deref();
        let (Noted::Acknowledged { alarm: key, .. }
        | Noted::Shelved { alarm: key, .. }
        | Noted::Unshelved { alarm: key, .. }) = noted
        else {
            return;
        };
        let Some(alarm) = self.list.iter_mut().find(|alarm| alarm.cause.key() == *key) else { return };
        match noted {
            Noted::Acknowledged { text, .. } if alarm.is_unacknowledged() && alarm.text == *text => {
                alarm.acknowledge(by, t_s);
            }
            Noted::Shelved { for_s, reason, .. } => alarm.shelve(t_s + for_s, reason, by),
            Noted::Unshelved { .. } => alarm.unshelve(),
            _ => {}
        }
    }

    /// The most urgent unacknowledged alarm whose cause persists; the oldest if there are several.
    pub fn worst_active_unacknowledged(&self) -> Option<&Alarm> {
        self.worst_of(|alarm| alarm.is_unacknowledged() && alarm.is_active())
    }

    /// The most severe unacknowledged alarm whose cause is gone; the oldest if there are several.
    pub fn worst_returned(&self) -> Option<&Alarm> {
        self.worst_of(|alarm| alarm.state == State::Returned)
    }

    fn worst_of(&self, counts: impl Fn(&Alarm) -> bool) -> Option<&Alarm> {
        self.open().rev().filter(|alarm| counts(alarm)).max_by_key(|alarm| alarm.rank())
    }

    /// The most urgent unacknowledged alarm; the oldest if there are several.
    pub fn worst_unacknowledged(&self) -> Option<&Alarm> {
        self.worst().filter(|alarm| alarm.is_unacknowledged())
    }

    /// Unshelves the alarms whose time is up, and settles those whose delays are over.
    pub fn expire(&mut self, t_s: f64) {
        self.settle(t_s);
        self.list.iter_mut().for_each(|alarm| alarm.expire(t_s));
    }

    /// Updates the figure of an alarm.
    pub fn read(&mut self, cause: &Cause, t_s: f64, reading: impl FnOnce() -> Reading) {
        if let Some(Next::Raise { readings, .. }) = self.waiting(cause) {
            readings.push((t_s, reading()));
            return;
        }
        if let Some(alarm) = self.get_mut(cause) {
            alarm.read(reading(), t_s);
        }
    }

    /// Records the number of a log line about an alarm, and the position to which the line refers.
    pub fn note(&mut self, cause: &Cause, number: u64, place: Option<Point>) {
        if let Some(Next::Raise { line, .. }) = self.waiting(cause) {
            *line = Some((number, place));
            return;
        }
        if let Some(alarm) = self.get_mut(cause) {
            alarm.note(number);
            if alarm.is_active() {
                alarm.place = place.or(alarm.place);
            }
        }
    }

    /// The alarm of a cause, if there is one.
    pub fn get(&self, cause: &Cause) -> Option<&Alarm> {
        self.list.iter().find(|alarm| alarm.cause == *cause)
    }

    fn get_mut(&mut self, cause: &Cause) -> Option<&mut Alarm> {
        self.list.iter_mut().find(|alarm| alarm.cause == *cause)
    }

    /// All alarms of the run, including cleared ones, in the order in which they first occurred.
    pub fn list(&self) -> &[Alarm] {
        &self.list
    }

    /// The open alarms: neither cleared nor shelved.
    pub fn open(&self) -> impl DoubleEndedIterator<Item = &Alarm> {
        self.list.iter().filter(|alarm| alarm.is_open())
    }

    /// All alarms in table order: open ones first, with the unacknowledged and most urgent at the top; then shelved
    /// ones; then cleared ones, newest first.
    pub fn table(&self) -> Vec<&Alarm> {
        let mut open: Vec<&Alarm> = self.open().collect();
        open.sort_by_key(|alarm| Reverse(alarm.rank()));
        let shelved = self.list.iter().filter(|alarm| matches!(alarm.state, State::Shelved(_)));
        let mut cleared: Vec<&Alarm> =
            self.list.iter().filter(|alarm| alarm.state == State::Cleared).collect();
        let cleared_s = |alarm: &Alarm| alarm.cleared_s.unwrap_or_default();
        cleared.sort_by(|one, other| cleared_s(other).total_cmp(&cleared_s(one)));
        open.into_iter().chain(shelved).chain(cleared).collect()
    }

    /// The alarm to show where only one fits: the most urgent one.
    pub fn worst(&self) -> Option<&Alarm> {
        self.worst_of(|_| true)
    }

    /// The number of open alarms of a severity.
    pub fn count(&self, severity: Severity) -> usize {
        self.open().filter(|alarm| alarm.severity == severity).count()
    }

    /// The number of unacknowledged alarms of a severity.
    pub fn unacknowledged(&self, severity: Severity) -> usize {
        self.open().filter(|alarm| alarm.severity == severity && alarm.is_unacknowledged()).count()
    }

    /// Whether an alarm was the first of a burst of several.
    pub fn is_first_out(&self, alarm: &Alarm) -> bool {
        let others = |other: &&Alarm| other.burst == alarm.burst && other.cause != alarm.cause;
        alarm.is_first && self.list.iter().any(|other| others(&other))
    }
}
