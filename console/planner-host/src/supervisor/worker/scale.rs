//! How much memory a busy worker has, checked often: the system limits only what it counts, and there are ways around that.

use crate::sandbox::MAY_HIDE;
use crate::supervisor::load::weight_of;
use rustix::process::Pid;
use std::time::{Duration, Instant};

/// Interval at which a busy worker is weighed: in this time a thread writes to about 30 MB of new memory.
const WEIGH_EVERY: Duration = Duration::from_millis(10);

/// Weighs a worker.
pub(super) struct Scale {
    /// Memory of its planner, bytes.
    limit: u64,
    look_at: Instant,
}

impl Scale {
    /// For a planner with this limit of memory, bytes.
    pub(super) fn new(limit: u64) -> Self {
        Self { limit, look_at: Instant::now() }
    }

    /// It was asked.
    pub(super) fn begin(&mut self, now: Instant) {
        self.look_at = now + WEIGH_EVERY;
    }

    /// When it has to be weighed next.
    pub(super) fn look_at(&self) -> Instant {
        self.look_at
    }

    /// Weighs it when it is time. Returns its limit, bytes, if it has more than that plus what a worker itself needs.
    pub(super) fn weigh(&mut self, process: Pid, now: Instant) -> Option<u64> {
        if now < self.look_at {
            return None;
        }
        self.look_at = now + WEIGH_EVERY;
        let has = weight_of(process)?;
        (has > self.limit.saturating_add(MAY_HIDE)).then_some(self.limit)
    }
}
