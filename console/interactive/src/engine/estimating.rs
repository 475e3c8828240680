//! Estimates for plans, computed on a separate thread so that the engine does not wait: what each plan leaves out and, for
//! those made before or at the start, the figures that they promise. The estimate of a plan is dropped if a newer plan is
//! being estimated.

use super::EngineThread;
use account::{Estimate, LeftOut};
use mission::{Event, EventKind, Phase};
use std::{thread, time::Duration};
use tui::RunMsg;

/// How long a plan that is made on the way must be the newest before the floor that it leaves out is computed. A robot
/// that meets obstacles makes many plans, most of which are replaced at once.
const SETTLES: Duration = Duration::from_millis(300);

impl EngineThread {
    /// Estimates the plans made in a tick. Only the plans made before the start, or the first plan if none was made before
    /// the start, promise figures.
    pub(super) fn estimate(&mut self, events: &[Event]) {
        for event in events {
            let EventKind::Planned { ask, path, complete, cuts, .. } = &event.kind else { continue };
            let promises = *self.flight.phase() == Phase::Waiting || !self.has_estimated;
            self.has_estimated = true;
            let (ask, path, complete, cuts) = (*ask, path.clone(), *complete, cuts.clone());
            let opened = self.flight.opened();
            let scanned = self.flight.mission().scanned().clone();
            let (mission, drawing) = (self.scenario.mission.clone(), self.scenario.sim.world.as_drawn());
            let (screen, turn) = (self.screen.clone(), self.estimates.begin());
            // If the thread cannot be started, the estimate is left out.
            let _ = thread::Builder::new().name("estimate".into()).spawn(move || {
                if promises {
                    let estimate = Estimate::new(&mission, &drawing, &path, complete);
                    turn.give(|| {
                        screen.send(RunMsg::Estimated(ask, Box::new(estimate)));
                    });
                } else {
                    thread::sleep(SETTLES);
                }
                let EventKind::RunOpened(run) = opened.kind else { return };
                if !turn.is_newest() {
                    return;
                }
                if let Some(left_out) = LeftOut::after(&run, &scanned, &path, &cuts, complete) {
                    turn.give(|| {
                        screen.send(RunMsg::LeftOut(ask, Box::new(left_out)));
                    });
                }
            });
        }
    }
}
