//! A planner on the processor of the thread that asks it.
//!
//! Whoever waits for every command gains nothing by a second processor: one of the two always sleeps. To hand over the
//! processor takes a fraction of the time that it takes to wake another one.

use crate::supervisor::Worker;
use rustix::thread::{CpuSet, sched_getaffinity, sched_getcpu, sched_setaffinity};
use std::time::{Duration, Instant};

/// For this time the two stay where they are; then the system may move them to a less busy processor.
const STAYS_FOR: Duration = Duration::from_millis(100);
/// How often a worker is checked for anything else as long as its answers come at once.
const LOOK_EVERY: Duration = Duration::from_millis(1);

/// The thread that asks, and perhaps the worker that shares its processor.
pub(super) struct Together {
    /// The processors that both may use while they are apart; `None` if there is no choice.
    all: Option<CpuSet>,
    /// Until when they stay together.
    until: Option<Instant>,
    /// When the last command was asked for, and when the worker was looked at for anything but answers.
    asked: Instant,
    looked: Instant,
}

impl Together {
    /// For the thread that calls this. They are apart.
    pub(super) fn new() -> Self {
        let now = Instant::now();
        let all = sched_getaffinity(None).ok().filter(|all| all.count() > 1);
        Self { all, until: None, asked: now, looked: now }
    }

    /// A command is about to be asked of a worker, which is the only one.
    pub(super) fn gather(&mut self, worker: &Worker) {
        let now = Instant::now();
        self.asked = now;
        match self.until {
            Some(until) if now < until => {}
            // This command finds them apart, and each may wake up on another processor.
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

    /// Whether the two share a processor and only an answer is to be expected for now; if not, everything has to be looked at.
    pub(super) fn may_look_later(&mut self) -> bool {
        let may = self.until.is_some() && self.asked.saturating_duration_since(self.looked) < LOOK_EVERY;
        if !may {
            self.looked = self.asked;
        }
        may
    }

    /// Something else is about to be done, for which all processors may be used, by new processes and threads, too.
    pub(super) fn part<'a>(&mut self, workers: impl Iterator<Item = &'a Worker>) {
        if let (Some(all), Some(_)) = (&self.all, self.until.take()) {
            // A thread that cannot be moved is slower, nothing worse.
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
