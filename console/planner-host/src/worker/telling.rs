//! How far the plan at hand is, told to the console as it comes, and not more often than anyone can read it.

use crate::Progress;
use crate::wire::{body::Writer, kind};
use rustix::net::{SendFlags, send};
use std::cell::{Cell, RefCell};
use std::os::fd::OwnedFd;
use std::time::{Duration, Instant};

/// The console is told no more often than this.
const TELL_EVERY: Duration = Duration::from_millis(50);

/// Tells the console how far the plan at hand is.
pub(super) struct Telling {
    socket: OwnedFd,
    /// Sequence number of the request, while it is one for a plan.
    plan: Cell<Option<u32>>,
    told: Cell<Option<Instant>>,
    /// What came too soon after the last; the newest.
    waiting: RefCell<Option<Progress>>,
}

impl Telling {
    /// No request yet.
    pub(super) fn new(socket: OwnedFd) -> Self {
        Self { socket, plan: Cell::new(None), told: Cell::new(None), waiting: RefCell::default() }
    }

    /// A request arrived; only those for a plan are told of.
    pub(super) fn begin(&self, kind: u8, sequence: u32) {
        self.plan.set((kind == kind::PLAN).then_some(sequence));
        self.told.set(None);
        self.waiting.take();
    }

    /// Takes how far the plan is: tells it now, or keeps it for later when the last was only just told.
    pub(super) fn take(&self, progress: Progress) {
        if self.plan.get().is_some() {
            self.waiting.replace(Some(progress));
            self.catch_up(Instant::now());
        }
    }

    /// Tells what had to wait, if it is time.
    pub(super) fn catch_up(&self, now: Instant) {
        if self.waiting.borrow().is_none() || self.told.get().is_some_and(|told| now - told < TELL_EVERY) {
            return;
        }
        if let (Some(sequence), Some(progress)) = (self.plan.get(), self.waiting.take()) {
            self.told.set(Some(now));
            self.write(Writer::default().begin(kind::PROGRESS, sequence, 0).progress(&progress));
        }
    }

    /// Writes a frame whole or not at all: a console that does not read holds nobody up.
    fn write(&self, writer: &mut Writer) {
        let Ok(mut rest) = writer.finish() else { return };
        let mut flags = SendFlags::DONTWAIT;
        while let Ok(n @ 1..) = send(&self.socket, rest, flags) {
            rest = &rest[n..];
            if rest.is_empty() {
                return;
            }
            // What has begun must end, or nothing that follows can be read.
            flags = SendFlags::empty();
        }
    }
}
