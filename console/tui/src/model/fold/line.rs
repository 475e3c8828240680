//! Turns events into log lines.

use crate::model::Run;
use crate::model::log::{Entry, Occurrence, Robot, What, slim};
use mission::{Event, EventKind, Severity, event::TetherAlarm};
use positioning::Ranging;

impl Run {
    /// Writes the log line of an event, if it has one; returns the number of the line.
    pub(super) fn write_line(&mut self, event: &Event) -> Option<u64> {
        let mut line = event.log_line(self.stations())?;
        // A planner says the same about the floor after each replan; once is enough.
        if matches!(event.kind, EventKind::PlannerLogged { .. }) && self.planning.has_said(&line.text) {
            line.severity = Severity::Debug;
        }
        // A certified plan may use the reel; only more than it promises is an alarm.
        if let EventKind::TetherAlarmRaised { alarm, reached: false } = &event.kind
            && let TetherAlarm::Reel { out_m, .. } = alarm
            && self.reel_limit_m().is_some_and(|limit_m| *out_m <= limit_m)
        {
            (line.severity, line.text) = (Severity::Info, format!("as planned: {alarm}"));
        }
        self.log.push(Entry {
            tick: event.tick,
            t_s: event.t_s,
            severity: line.severity,
            source: line.source.into(),
            text: line.text,
            count: 1,
            what: self.what(&event.kind),
        });
        self.log.newest()
    }

    fn what(&self, kind: &EventKind) -> What {
        if matches!(kind, EventKind::RunOpened(_)) {
            return What::Opened;
        }
        let position = &self.position;
        let robot = position.pose.as_ref().map(|pose| Robot {
            at: pose.position,
            heading_rad: pose.heading_rad,
            error_m: position.error_m().unwrap_or(f64::NAN),
            speed_m_per_s: position.speed_m_per_s(),
        });
        let range = self.range_of(kind);
        What::Event(Box::new(Occurrence { kind: slim(kind), robot, range }))
    }

    fn range_of(&self, kind: &EventKind) -> Option<Ranging> {
        let (EventKind::StationRejected { station, .. } | EventKind::StationRestored { station }) = kind
        else {
            return None;
        };
        self.position.ranges.iter().find(|range| range.station == *station).copied()
    }
}
