//! Folds tether events into a run.

use crate::model::{Cause, Run};
use mission::{Event, EventKind, Severity, event::TetherAlarm};

impl Run {
    /// Forgets the last certificate, because its plan no longer runs.
    pub(super) fn forget_certificate(&mut self) {
        self.tether.iter_mut().for_each(|tether| tether.certified = None);
    }

    /// Folds in a tether event.
    pub(super) fn tethered(&mut self, event: &Event) {
        match &event.kind {
            EventKind::TetherAlarmRaised { alarm, .. } => {
                if matches!(alarm, TetherAlarm::Snag { .. }) {
                    self.tether.get_or_insert_default().is_snagged = true;
                }
                self.raise_as_logged(event, Cause::Tether(alarm.word().to_owned()));
            }
            EventKind::TetherAlarmCleared { alarm } => {
                if matches!(alarm, TetherAlarm::Snag { .. }) {
                    self.tether.get_or_insert_default().is_snagged = false;
                }
                self.clear(&Cause::Tether(alarm.word().to_owned()));
            }
            // The planner is a candidate; the reason why it does not take over is reported when the planner is
            // rejected.
            EventKind::Certified { .. } if self.planning.proposed => {}
            EventKind::Certified { planner, refused, certificate } => {
                self.tether.get_or_insert_default().certified = Some(certificate.certified);
                if certificate.certified {
                    self.clear(&Cause::Certificate);
                } else {
                    let severity = if *refused { Severity::Crit } else { Severity::Warn };
                    let reasons = certificate.reasons.join("; ");
                    let text = format!("plan of {planner} not certified: {reasons}");
                    self.raise(event, Cause::Certificate, severity, text);
                }
            }
            other => {
                let anchor = self.about.as_ref().and_then(|about| about.mission.tether.as_ref());
                let ends =
                    anchor.map(|tether| tether.anchor).zip(self.position.pose.map(|pose| pose.position));
                self.tether.get_or_insert_default().lie(event.t_s, other, ends);
            }
        }
    }
}
