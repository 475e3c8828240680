//! Retired workers: how the host ends them, and the outcome.

use super::Host;
use super::spare::Spare;
use crate::remains::BadEnd;
use crate::supervisor::{Ready, Worker};
use crate::wire::SHUT_DOWN_WITHIN;
use mission::WorkerId;
use std::time::Instant;

/// A worker that is being ended.
pub(super) struct Leaving {
    /// The planner that it had; empty if it had none yet.
    planner: String,
    pub(super) worker: Worker,
}

impl Host {
    /// Ends a worker and drops what it was asked.
    pub(crate) fn close(&mut self, id: WorkerId) {
        if let Some(index) = self.planners.iter().position(|planner| planner.id == id) {
            let mut planner = self.planners.swap_remove(index);
            if let Some(worker) = planner.worker.take() {
                self.dismiss(planner.name(), worker);
            }
        }
        self.answers.retain(|answer| answer.ask.worker != id);
    }

    /// Asks a worker to exit by itself, and leaves it to its end.
    pub(super) fn dismiss(&mut self, planner: &str, mut worker: Worker) {
        worker.shut_down();
        self.leave(planner, worker);
    }

    /// Leaves a worker to its end.
    pub(super) fn leave(&mut self, planner: &str, mut worker: Worker) {
        self.kept.note_printed(planner, worker.take_printed());
        if !worker.is_gone() {
            self.leaving.push(Leaving { planner: planner.to_owned(), worker });
        }
    }

    /// Asks all workers to exit by themselves, and waits until they have: a moment, or as long as they are given for it.
    pub fn finish(&mut self) {
        self.place(None);
        self.answers.clear();
        for mut planner in std::mem::take(&mut self.planners) {
            if let Some(worker) = planner.worker.take() {
                self.dismiss(planner.name(), worker);
            }
        }
        for Spare { worker, loaded } in self.spares.take_all() {
            self.dismiss(&loaded.info.id, worker);
        }
        let until = Instant::now() + 2 * SHUT_DOWN_WITHIN;
        while !self.leaving.is_empty() && Instant::now() < until {
            self.clear_wake_ups();
            self.look(Some(until));
        }
    }

    /// Looks after workers that are being ended, without waiting; whether there are any left.
    ///
    /// [`Self::next`] does so as well: this is for times when nothing is asked.
    pub fn look_after_leaving(&mut self) -> bool {
        if !self.leaving.is_empty() {
            self.look(Some(Instant::now()));
        }
        !self.leaving.is_empty()
    }

    /// Removes a worker that can no longer be asked.
    pub(super) fn retire(&mut self, id: WorkerId) {
        let unasked = self.planners.iter_mut().find(|planner| planner.id == id && planner.asked.is_none());
        let ended = unasked.and_then(|planner| {
            let worker = planner.worker.take_if(|worker| !worker.is_idle())?;
            Some((planner.name().to_owned(), worker))
        });
        if let Some((planner, worker)) = ended {
            self.leave(&planner, worker);
        }
    }

    /// Does what is due for workers that are being ended, with what the last look found of each.
    pub(super) fn advance_leaving(&mut self, ready: &[Ready], now: Instant) {
        let mut ready = ready.iter().copied();
        for mut leaving in std::mem::take(&mut self.leaving) {
            if let Some(ready) = ready.next() {
                leaving.worker.advance(ready, now, &mut |_| {});
            }
            if leaving.worker.is_gone() {
                self.note_end(leaving);
            } else {
                self.leaving.push(leaving);
            }
        }
    }

    fn note_end(&mut self, Leaving { planner, mut worker }: Leaving) {
        self.kept.note_printed(&planner, worker.take_last_printed());
        if let Some(how) = worker.take_bad_end() {
            self.kept.note_bad_end(BadEnd { planner, how });
        }
    }
}
