//! What may happen to a worker, and what has.

use rustix::event::PollFlags;
use std::os::fd::BorrowedFd;

/// What a worker's descriptor is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    /// Carries answers, and has room for requests.
    Socket,
    /// Becomes readable when the process ends.
    Exit,
    /// What it prints.
    Output,
    /// System calls that are waiting for a decision.
    Calls,
}

/// A descriptor to wait for, and for what.
pub(super) type Watched<'a> = (Source, BorrowedFd<'a>, PollFlags);

/// What has happened to a worker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Ready {
    socket: PollFlags,
    /// The process has ended.
    pub(super) exited: bool,
    /// It printed something, or closed its output.
    pub(super) printed: bool,
    /// A system call of it is waiting for a decision.
    pub(super) called: bool,
}

impl Ready {
    /// What is known before the first look.
    pub(super) const NOTHING: Self =
        Self { socket: PollFlags::empty(), exited: false, printed: false, called: false };

    /// Nobody has asked the system, but an answer may have come, and lines before it.
    pub(crate) const PERHAPS_ANSWERED: Self =
        Self { socket: PollFlags::IN, exited: false, printed: true, called: false };

    /// Something arrived, or the other side hung up.
    pub(super) fn readable(self) -> bool {
        !self.socket.difference(PollFlags::OUT).is_empty()
    }

    /// There is room for more of the request.
    pub(super) fn writable(self) -> bool {
        self.socket.contains(PollFlags::OUT)
    }

    /// Notes what has happened to one of its descriptors.
    pub(super) fn note(&mut self, source: Source, happened: PollFlags) {
        match source {
            Source::Socket => self.socket = happened,
            Source::Exit => self.exited = !happened.is_empty(),
            Source::Output => self.printed = !happened.is_empty(),
            Source::Calls => self.called = happened.contains(PollFlags::IN),
        }
    }
}
