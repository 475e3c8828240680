//! Processes of planners whose mission has ended, kept for the next mission.

use super::opening::Loaded;
use crate::supervisor::Worker;

/// The maximum number of processes kept. A mission needs one or two; a campaign needs one for each planner that it
/// compares.
const MOST: usize = 16;

/// An idle worker that has loaded a planner.
pub(super) struct Spare {
    pub(super) worker: Worker,
    pub(super) loaded: Loaded,
}

/// One worker for each planner; the most recently used one is last.
#[derive(Default)]
pub(super) struct Spares(Vec<Spare>);

impl Spares {
    /// Keeps a worker; returns the worker that it displaces, if any.
    pub(super) fn keep(&mut self, worker: Worker, loaded: Loaded) -> Option<Worker> {
        let same = self.0.iter().position(|spare| spare.loaded.info.id == loaded.info.id);
        let surplus = same.or((self.0.len() >= MOST).then_some(0)).map(|at| self.0.remove(at).worker);
        self.0.push(Spare { worker, loaded });
        surplus
    }

    /// Takes the worker that has loaded this planner.
    pub(super) fn take(&mut self, planner: &str) -> Option<Spare> {
        let at = self.0.iter().position(|spare| spare.loaded.info.id == planner)?;
        Some(self.0.remove(at))
    }

    /// Takes all workers.
    pub(super) fn take_all(&mut self) -> Vec<Spare> {
        std::mem::take(&mut self.0)
    }

    /// Iterates over all workers.
    pub(super) fn workers(&mut self) -> impl Iterator<Item = &mut Worker> {
        self.0.iter_mut().map(|spare| &mut spare.worker)
    }
}
