//! Retired workers: how the host ends them, and what it reports about their ends.

use super::Host;
use super::spare::Spare;
use crate::remains::BadEnd;
use crate::supervisor::{Ready, Worker};
use crate::wire::SHUT_DOWN_WITHIN;
use mission::WorkerId;
use std::time::Instant;

/// A worker that is being ended.
pub(super) struct Leaving {
    /// The id of the worker's planner; empty if the worker had no planner yet.
    planner: String,
    pub(super) worker: Worker,
}

impl Host {
    /// Closes a worker and drops its open ask.
    pub(crate) fn close(&mut self, id: WorkerId) {
        if let Some(index) = self.planners.iter().position(|planner| planner.id == id) {
            let mut planner = self.planners.swap_remove(index);
            if let Some(worker) = planner.worker.take() {
                self.dismiss(planner.name(), worker);
            }
        }
        self.answers.retain(|answer| answer.ask.worker != id);
    }

    /// Asks a worker to exit, and keeps it until its process has ended.
    pub(super) fn dismiss(&mut self, planner: &str, mut worker: Worker) {
        worker.shut_down();
        self.leave(planner, worker);
    }

    /// Keeps a worker until its process has ended.
    pub(super) fn leave(&mut self, planner: &str, mut worker: Worker) {
        self.kept.note_printed(planner, worker.take_printed());
        if !worker.is_gone() {
            self.leaving.push(Leaving { planner: planner.to_owned(), worker });
        }
    }

    /// Asks all workers to exit, and waits until they have done so or their grace period is over.
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

    /// Processes workers that are being ended, without waiting. Returns whether any are left.
    ///
    /// [`Self::next`] does this, too; call this function when no ask is open.
    pub fn look_after_leaving(&mut self) -> bool {
        if !self.leaving.is_empty() {
            self.look(Some(Instant::now()));
        }
        !self.leaving.is_empty()
    }

    /// Removes a worker that can no longer answer.
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

    /// Processes the workers that are being ended; `ready` contains each worker's events from the last poll.
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
