//! What the plan that is shown before the start promises; computed beside the engine, which waits for nothing.

use super::EngineThread;
use mission::{Event, EventKind, Phase};
use report::Estimate;
use std::thread;
use tui::RunMsg;

impl EngineThread {
    /// Estimates the plans that were made in a tick before the start.
    pub(super) fn estimate(&self, events: &[Event]) {
        if *self.flight.phase() != Phase::Waiting {
            return;
        }
        for event in events {
            let EventKind::Planned { ask, path, complete, .. } = &event.kind else { continue };
            let (ask, path, complete) = (*ask, path.clone(), *complete);
            let (mission, drawing) = (self.scenario.mission.clone(), self.scenario.sim.world.as_drawn());
            let screen = self.screen.clone();
            // A system that gives no thread leaves the figures out.
            let _ = thread::Builder::new().name("estimate".into()).spawn(move || {
                let estimate = Estimate::new(&mission, &drawing, &path, complete);
                screen.send(RunMsg::Estimated(ask, Box::new(estimate)));
            });
        }
    }
}
