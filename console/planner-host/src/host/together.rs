//! Runs a planner on the processor of the thread that asks it.
//!
//! A caller that waits for every command gains nothing from a second processor, because one of the two threads always
//! sleeps. Switching to the other thread on the same processor takes a fraction of the time needed to wake a second
//! processor.

use crate::supervisor::Worker;
use rustix::thread::{CpuSet, sched_getaffinity, sched_getcpu, sched_setaffinity};
use std::time::{Duration, Instant};

/// Time for which the two threads stay on the same processor before the system may move them to a less busy one.
const STAYS_FOR: Duration = Duration::from_millis(100);
/// Interval at which a worker is checked for other events while its answers come immediately.
const LOOK_EVERY: Duration = Duration::from_millis(1);

/// The asking thread, and possibly the worker that shares its processor.
pub(super) struct Together {
    /// The processors that both threads may use while they are separate; `None` if there is only one processor.
    all: Option<CpuSet>,
    /// The time until which the threads share a processor; `None` while they are separate.
    until: Option<Instant>,
    /// When the last command was requested, and when the worker was last checked for other events.
    asked: Instant,
    looked: Instant,
}

impl Together {
    /// Creates the state for the calling thread, which shares its processor with no worker yet.
    pub(super) fn new() -> Self {
        let now = Instant::now();
        let all = sched_getaffinity(None).ok().filter(|all| all.count() > 1);
        Self { all, until: None, asked: now, looked: now }
    }

    /// Moves the worker to this processor; call it before a command is requested from the only worker.
    pub(super) fn gather(&mut self, worker: &Worker) {
        let now = Instant::now();
        self.asked = now;
        match self.until {
            Some(until) if now < until => {}
            // For this command, the two threads are separate, so the system may wake each on a different processor.
            Some(_) => self.part(std::iter::once(worker)),
            None if self.all.is_some() && sched_getcpu() < CpuSet::MAX_CPU => {
                let mut here = CpuSet::new();
                here.set(sched_getcpu());
                if sched_setaffinity(None, &here).is_ok() {
                    worker.stay_on(&here);
                    self.until = Some(now + STAYS_FOR);
                }
            }
            None => {}
        }
    }

    /// Whether the two threads share a processor and only an answer is expected for now. If not, all events must
    /// be checked.
    pub(super) fn may_look_later(&mut self) -> bool {
        let may = self.until.is_some() && self.asked.saturating_duration_since(self.looked) < LOOK_EVERY;
        if !may {
            self.looked = self.asked;
        }
        may
    }

    /// Lets this thread and the workers use all processors again. Call this before anything but a command, because new
    /// processes and threads inherit the setting.
    pub(super) fn part<'a>(&mut self, workers: impl Iterator<Item = &'a Worker>) {
        if let (Some(all), Some(_)) = (&self.all, self.until.take()) {
            // If a thread cannot be moved, it only runs more slowly.
            let _ = sched_setaffinity(None, all);
            workers.for_each(|worker| worker.stay_on(all));
        }
    }
}

impl Drop for Together {
    fn drop(&mut self) {
        self.part(std::iter::empty());
    }
}
