//! Estimates for the plans made before or at the start, computed on a separate thread so that the engine does not wait.
//! The estimate of a plan is dropped if a newer plan is being estimated.

use super::EngineThread;
use account::{Estimate, LeftOut};
use mission::{Event, EventKind, Phase};
use std::thread;
use tui::RunMsg;

impl EngineThread {
    /// Estimates the plans made in a tick before the start, or the first plan if none was made before the start.
    pub(super) fn estimate(&mut self, events: &[Event]) {
        if *self.flight.phase() != Phase::Waiting && self.has_estimated {
            return;
        }
        for event in events {
            let EventKind::Planned { ask, path, complete, cuts, .. } = &event.kind else { continue };
            self.has_estimated = true;
            let (ask, path, complete, cuts) = (*ask, path.clone(), *complete, cuts.clone());
            let opened = self.flight.opened();
            let (mission, drawing) = (self.scenario.mission.clone(), self.scenario.sim.world.as_drawn());
            let (screen, turn) = (self.screen.clone(), self.estimates.begin());
            // If the thread cannot be started, the estimate is left out.
            let _ = thread::Builder::new().name("estimate".into()).spawn(move || {
                let estimate = Estimate::new(&mission, &drawing, &path, complete);
                turn.give(|| {
                    screen.send(RunMsg::Estimated(ask, Box::new(estimate)));
                });
                let EventKind::RunOpened(run) = opened.kind else { return };
                if let Some(left_out) = LeftOut::of(&run, &path, &cuts, complete) {
                    turn.give(|| {
                        screen.send(RunMsg::LeftOut(ask, Box::new(left_out)));
                    });
                }
            });
        }
    }
}
