//! Events of the robot's position into a run.

use crate::model::{Cause, Change, Run, Withdrawn};
use mission::{Event, EventKind, Severity};
use positioning::Exclusion;
use world::StationId;

impl Run {
    /// Takes in an event of the robot's position.
    pub(super) fn locate(&mut self, event: &Event, change: &mut Change) {
        match &event.kind {
            EventKind::Ranged { ranges } => self.position.ranged(event.t_s, ranges.len()),
            EventKind::Fixed { fix } => {
                (self.position.fix, self.position.fix_t_s) = (Some(fix.clone()), event.t_s);
                self.position.failure = None;
                self.alarms.clear(&Cause::NoFix);
            }
            EventKind::FixFailed { error, .. } => {
                self.position.failure = Some(error.to_string());
                self.raise(event, Cause::NoFix, Severity::Watch, format!("no fix: {error}"));
            }
            EventKind::StationRejected { station, reason } => self.exclude(event, *station, reason),
            EventKind::StationRestored { station } => self.alarms.clear(&Cause::Station(*station)),
            EventKind::Estimated { pose } => {
                self.position.estimated(event.t_s, *pose);
                self.trail.add(pose.position);
            }
            EventKind::PositionLost { .. } => {
                self.position.lost = true;
                self.raise_as_logged(event, Cause::PositionLost);
                change.withdraw(Withdrawn::All);
            }
            EventKind::PositionRegained { .. } => {
                self.position.lost = false;
                self.alarms.clear(&Cause::PositionLost);
            }
            EventKind::RangesInconsistent { .. } => {
                self.raise(
                    event,
                    Cause::Contradiction,
                    Severity::Crit,
                    "ranges contradict each other".into(),
                );
                change.withdraw(Withdrawn::All);
            }
            EventKind::RangesConsistent => self.alarms.clear(&Cause::Contradiction),
            _ => {}
        }
    }

    fn exclude(&mut self, event: &Event, station: StationId, reason: &Exclusion) {
        let name = self.station_name(station);
        let why = match reason {
            Exclusion::Silent => "not heard".to_owned(),
            Exclusion::Residual { residual_m, gate_m } => {
                format!("residual {residual_m:.2} m, gate {gate_m:.2} m")
            }
        };
        self.raise(event, Cause::Station(station), Severity::Watch, format!("{name} rejected: {why}"));
    }
}
