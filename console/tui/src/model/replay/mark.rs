//! The marks to which the operator can jump in a run: events, alarms, holds.

use crate::model::Run;
use mission::{Event, EventKind, Severity};
use serde::{Deserialize, Serialize};

/// The kind of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum MarkKind {
    /// A line of the log.
    Event,
    /// The robot was held.
    Hold,
    /// An alarm was raised.
    Alarm,
}

/// A moment to which the operator can jump.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Mark {
    /// Mission time, seconds.
    pub t_s: f64,
    /// The severity.
    pub severity: Severity,
    /// The kind of the mark.
    pub kind: MarkKind,
}

/// Finds the marks while folding a run.
#[derive(Debug, Clone, Default)]
pub struct Marker {
    /// The number of log lines so far.
    lines: u64,
    /// The number of active alarms before the event.
    active: usize,
}

impl Marker {
    /// Folds an event into a run; returns the mark for the event if it has one.
    pub fn fold(&mut self, run: &mut Run, event: &Event) -> Option<Mark> {
        run.fold(event);
        let lines = run.log.end();
        if std::mem::replace(&mut self.lines, lines) == lines {
            return None;
        }
        let active = run.alarms.list().iter().filter(|alarm| alarm.is_active()).count();
        let is_alarm = std::mem::replace(&mut self.active, active) < active;
        let kind = match event.kind {
            _ if is_alarm => MarkKind::Alarm,
            EventKind::Held { .. } => MarkKind::Hold,
            _ => MarkKind::Event,
        };
        let severity = run.log.get(lines - 1).map_or(Severity::Info, |entry| entry.severity);
        Some(Mark { t_s: event.t_s, severity, kind })
    }
}
