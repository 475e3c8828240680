//! The promises of a past run: a journal contains the plan of the start, but not the figures that the console promised
//! for it. These follow from the plan, the mission and the drawing alone, so they are computed again.

use super::inbox::RunOutbox;
use mission::{Event, EventKind, event::RunOpened};
use recording::{JournalReader, journal_of};
use std::{path::Path, thread};
use tui::{RunMsg, model::Promise};

/// Finds the plan with which a run begins: the last one before the start or, without one, the first one after it.
#[derive(Default)]
pub(super) struct StartPlan {
    run: Option<Box<RunOpened>>,
    plan: Option<EventKind>,
    has_started: bool,
    is_found: bool,
}

impl StartPlan {
    /// Takes the next event; returns the run and its plan once both are known.
    pub(super) fn take(&mut self, event: &Event) -> Option<(Box<RunOpened>, EventKind)> {
        if let EventKind::RunOpened(run) = &event.kind {
            self.run = Some(run.clone());
        }
        let plan = self.plan_of(&event.kind)?;
        self.run.take().map(|run| (run, plan))
    }

    /// The plan of the start, once it is known.
    fn plan_of(&mut self, kind: &EventKind) -> Option<EventKind> {
        if self.is_found {
            return None;
        }
        match kind {
            EventKind::Planned { .. } => self.plan = Some(kind.clone()),
            EventKind::Ordered { order } if order.is_start() => self.has_started = true,
            _ => {}
        }
        self.is_found = self.has_started && self.plan.is_some();
        self.plan.take_if(|_| self.is_found)
    }
}

/// Computes a promise on a separate thread, and sends it to the screen.
pub(super) fn send((run, plan): (Box<RunOpened>, EventKind), screen: RunOutbox) {
    // If the thread cannot be started, the promise is left out.
    let _ = thread::Builder::new().name("promise".into()).spawn(move || {
        if let Some(promise) = Promise::new(&run, &plan) {
            screen.send(RunMsg::Promised(Box::new(promise)));
        }
    });
}

/// Reads the journal in a folder up to the plan of the start, and sends its promise to the screen. A problem in the
/// journal is reported by its other readers.
pub(super) fn read(folder: &Path, screen: &RunOutbox) {
    let mut start = StartPlan::default();
    let Ok(reader) = JournalReader::open(&journal_of(folder)) else { return };
    let found = reader.map_while(Result::ok).find_map(|event| start.take(&event));
    if let Some(found) = found {
        send(found, screen.clone());
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use mission::Order;

    fn planned(length_m: f64) -> EventKind {
        serde_json::from_value(serde_json::json!({
            "event": "planned", "planner": "apf", "reason": "start", "path": [], "length_m": length_m, "complete": true
        }))
        .unwrap()
    }

    fn found(kinds: &[EventKind]) -> Option<EventKind> {
        let mut start = StartPlan::default();
        kinds.iter().find_map(|kind| start.plan_of(kind))
    }

    #[test]
    fn the_plan_of_the_start_is_the_last_one_before_it_or_the_first_one_after_it() {
        let start = || EventKind::Ordered { order: Order::Start };
        assert_eq!(found(&[planned(1.0), planned(2.0), start(), planned(3.0)]), Some(planned(2.0)));
        assert_eq!(found(&[start(), planned(3.0), planned(4.0)]), Some(planned(3.0)));
        assert_eq!(found(&[planned(1.0)]), None, "not started");
    }
}
