//! What the plan that is flown first promises; computed beside the engine, which waits for nothing.

use super::EngineThread;
use account::Estimate;
use mission::{Event, EventKind, Phase};
use std::thread;
use tui::RunMsg;

impl EngineThread {
    /// Estimates the plans that were made in a tick before the start, or the first one if none was made by then.
    pub(super) fn estimate(&mut self, events: &[Event]) {
        if *self.flight.phase() != Phase::Waiting && self.has_estimated {
            return;
        }
        for event in events {
            let EventKind::Planned { ask, path, complete, .. } = &event.kind else { continue };
            self.has_estimated = true;
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
