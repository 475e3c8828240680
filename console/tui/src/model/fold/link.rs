//! Folds the link to a real vehicle into a run.

use crate::model::{Cause, Run};
use mission::{Event, EventKind};
use vehicle::port::{LinkState, Notice};

impl Run {
    /// Folds in an event about the link, whether the vehicle stands still, or the end of its wait for a position.
    pub(super) fn linked(&mut self, event: &Event) {
        match &event.kind {
            EventKind::Link(link) => {
                let now = cause(link.state);
                let all = [Cause::Link, Cause::Vehicle, Cause::ConsoleStopped];
                for cause in all.into_iter().filter(|cause| Some(cause) != now.as_ref()) {
                    self.clear(&cause);
                }
                // The figures come every 10 s.
                if self.vehicle.as_ref().is_some_and(|before| before.link.faulty == link.faulty) {
                    self.clear(&Cause::FaultyMessages);
                }
                if let Some(cause) = now {
                    self.raise_as_logged(event, cause);
                }
                self.vehicle.get_or_insert_default().link = link.clone();
            }
            EventKind::Noticed(Notice::FaultyMessages { .. }) => {
                self.raise_as_logged(event, Cause::FaultyMessages);
            }
            EventKind::Noticed(Notice::ClockRate { is_off: true, .. }) => {
                self.raise_as_logged(event, Cause::VehicleClock);
            }
            EventKind::Noticed(Notice::ClockRate { is_off: false, .. }) => self.clear(&Cause::VehicleClock),
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
        LinkState::ConsoleStopped => Some(Cause::ConsoleStopped),
        LinkState::Restarted
        | LinkState::OtherVehicle
        | LinkState::Manual
        | LinkState::EmergencyStop
        | LinkState::VehicleFault
        | LinkState::OtherCommander => Some(Cause::Vehicle),
    }
}
