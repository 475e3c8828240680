//! Folds the link to a real vehicle into a run.

use crate::model::{Cause, Run};
use mission::{Event, EventKind};
use vehicle::port::LinkState;

impl Run {
    /// Folds in an event about the link, whether the vehicle stands still, or the end of its wait for a position.
    pub(super) fn linked(&mut self, event: &Event) {
        match &event.kind {
            EventKind::Link(link) => {
                let now = cause(link.state);
                for cause in
                    [Cause::Link, Cause::Vehicle].into_iter().filter(|cause| Some(cause) != now.as_ref())
                {
                    self.clear(&cause);
                }
                if let Some(cause) = now {
                    self.raise_as_logged(event, cause);
                }
                self.vehicle.get_or_insert_default().link = link.clone();
            }
            EventKind::Stood { confirmed, .. } => {
                self.vehicle.get_or_insert_default().stands = Some(*confirmed);
                if *confirmed {
                    self.clear(&Cause::StopNotConfirmed);
                } else {
                    self.raise_as_logged(event, Cause::StopNotConfirmed);
                }
            }
            // A motion makes an earlier confirmation obsolete; a command to stand still begins the wait for a new one.
            EventKind::Sent { .. } => self.vehicle.get_or_insert_default().stands = None,
            EventKind::PositionAwaited { ends_t_s, .. } => {
                self.vehicle.get_or_insert_default().waits_until_s = Some(*ends_t_s);
            }
            EventKind::Resumed => {
                self.vehicle.iter_mut().for_each(|vehicle| vehicle.waits_until_s = None);
            }
            _ => {}
        }
    }
}

fn cause(state: LinkState) -> Option<Cause> {
    match state {
        LinkState::Up => None,
        LinkState::Lost | LinkState::Closed | LinkState::Faulty => Some(Cause::Link),
        LinkState::Restarted
        | LinkState::Manual
        | LinkState::EmergencyStop
        | LinkState::VehicleFault
        | LinkState::OtherCommander => Some(Cause::Vehicle),
    }
}
