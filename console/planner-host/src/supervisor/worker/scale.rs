//! Checks the memory of a busy worker frequently: the system limits only the memory that it counts, and this limit can
//! be circumvented.

use crate::sandbox::MAY_HIDE;
use crate::supervisor::load::weight_of;
use rustix::process::Pid;
use std::time::{Duration, Instant};

/// Interval at which the memory of a busy worker is measured. In between, a thread can write to about 30 MB of new
/// memory.
const WEIGH_EVERY: Duration = Duration::from_millis(10);

/// Measures the memory of a worker.
pub(super) struct Scale {
    /// The planner's memory limit, bytes.
    limit: u64,
    look_at: Instant,
}

impl Scale {
    /// Creates a scale for a planner with this memory limit, bytes.
    pub(super) fn new(limit: u64) -> Self {
        Self { limit, look_at: Instant::now() }
    }

    /// Starts measuring when a request is sent.
    pub(super) fn begin(&mut self, now: Instant) {
        self.look_at = now + WEIGH_EVERY;
    }

    /// Returns the time of the next measurement.
    pub(super) fn look_at(&self) -> Instant {
        self.look_at
    }

    /// Measures the memory of the worker when a measurement is due. Returns the limit, bytes, if the worker exceeds it
    /// by more than a worker itself needs.
    pub(super) fn weigh(&mut self, process: Pid, now: Instant) -> Option<u64> {
        if now < self.look_at {
            return None;
        }
        self.look_at = now + WEIGH_EVERY;
        let has = weight_of(process)?;
        (has > self.limit.saturating_add(MAY_HIDE)).then_some(self.limit)
    }
}
