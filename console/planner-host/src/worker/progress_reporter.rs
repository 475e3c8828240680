//! Reports the progress of the current plan to the console, no faster than a person can read it.

use super::Socket;
use crate::Progress;
use crate::wire::{body::Writer, kind};
use rustix::net::{SendFlags, send};
use std::cell::{Cell, RefCell};
use std::time::{Duration, Instant};

/// Minimum time between two reports.
const REPORT_EVERY: Duration = Duration::from_millis(50);

/// Reports the progress of the current plan to the console.
pub(super) struct ProgressReporter {
    socket: Socket,
    /// Sequence number of the request, if it is for a plan.
    plan: Cell<Option<u32>>,
    reported_at: Cell<Option<Instant>>,
    /// The newest progress that came too soon after the last report.
    waiting: RefCell<Option<Progress>>,
}

impl ProgressReporter {
    /// Creates the reporter before the first request.
    pub(super) fn new(socket: Socket) -> Self {
        Self { socket, plan: Cell::new(None), reported_at: Cell::new(None), waiting: RefCell::default() }
    }

    /// Begins a request; progress is reported only for a plan.
    pub(super) fn begin(&self, kind: u8, sequence: u32) {
        self.plan.set((kind == kind::PLAN).then_some(sequence));
        self.reported_at.set(None);
        self.waiting.take();
    }

    /// Accepts progress: reports it now, or keeps it for later if the last report is too recent.
    pub(super) fn take(&self, progress: Progress) {
        if self.plan.get().is_some() {
            self.waiting.replace(Some(progress));
            self.catch_up(Instant::now());
        }
    }

    /// Reports the progress kept for later, if it is due.
    pub(super) fn catch_up(&self, now: Instant) {
        let is_too_soon = self.reported_at.get().is_some_and(|at| now - at < REPORT_EVERY);
        if self.waiting.borrow().is_none() || is_too_soon {
            return;
        }
        if let (Some(sequence), Some(progress)) = (self.plan.get(), self.waiting.take()) {
            self.reported_at.set(Some(now));
            self.write(Writer::default().begin(kind::PROGRESS, sequence, 0).put(&progress));
        }
    }

    /// Writes a frame completely or not at all, so that nothing blocks if the console does not read.
    fn write(&self, writer: &mut Writer) {
        let Ok(mut rest) = writer.finish() else { return };
        let mut flags = SendFlags::DONTWAIT;
        while let Ok(n @ 1..) = send(&self.socket, rest, flags) {
            rest = &rest[n..];
            if rest.is_empty() {
                return;
            }
            // A frame that was begun must be completed; otherwise nothing after it could be read.
            flags = SendFlags::empty();
        }
    }
}
