//! The next ask to a planner.

use super::{Mission, role::Preparing, worker::Worker};
use crate::ask::{Ask, Awaits};

impl Mission {
    /// Returns the next ask to a planner, if there is one. Call it until it returns `None`, after [`Mission::sense`] and
    /// after every [`Mission::answer`].
    pub fn poll_ask(&mut self) -> Option<Ask> {
        let waits_for_other = self.preparing.as_ref().is_some_and(Preparing::robot_waits);
        let Self { known, workers, driving, .. } = self;
        workers
            .poll()
            .or_else(|| driving.next_ask(known, workers, waits_for_other))
            .or_else(|| self.ask_preparing())
            .or_else(|| self.shadow.as_mut()?.next_ask(&self.known, &mut self.workers))
    }

    /// The answer that the mission would like to have before the tick ends.
    pub fn awaits(&self) -> Awaits {
        if let Some(awaited) = self.driving.awaits(&self.known) {
            return awaited;
        }
        let preparing = self.preparing.as_ref().filter(|preparing| preparing.worker.pending.is_some());
        let shadow = self.shadow.as_ref().filter(|shadow| shadow.worker.pending.is_some());
        match (preparing, shadow) {
            (Some(preparing), _) if self.known.follows_planner() && preparing.robot_waits() => Awaits::Work,
            (Some(_), _) => Awaits::Candidate,
            (None, Some(_)) => Awaits::Shadow,
            (None, None) => Awaits::Nothing,
        }
    }

    /// Whether no scan has arrived yet, although the robot moves only with one.
    pub fn awaits_scan(&self) -> bool {
        self.known.awaits_scan()
    }

    /// Whether a planner is being opened or is making a plan, even if the robot is not waiting for it.
    pub fn is_preparing(&self) -> bool {
        let preparing = self.preparing.as_ref().map(|preparing| &preparing.worker);
        let shadow = self.shadow.as_ref().map(|shadow| &shadow.worker);
        let workers = std::iter::once(&self.driving.worker).chain(preparing).chain(shadow);
        workers.into_iter().any(Worker::is_being_prepared)
    }
}
