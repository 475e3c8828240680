//! The kinds of events that a worker can have, and the events that have happened.

use rustix::event::PollFlags;
use std::os::fd::BorrowedFd;

/// The purpose of a worker's descriptor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    /// Receives answers and sends requests.
    Socket,
    /// Becomes readable when the process ends.
    Exit,
    /// The output of the process.
    Output,
    /// System calls that are waiting for a decision.
    Calls,
}

/// A descriptor, its purpose, and the events to wait for.
pub(super) type Watched<'a> = (Source, BorrowedFd<'a>, PollFlags);

/// The events of a worker since the last poll.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Ready {
    socket: PollFlags,
    /// The process has ended.
    pub(super) exited: bool,
    /// The process printed something, or closed its output.
    pub(super) printed: bool,
    /// A system call of the process is waiting for a decision.
    pub(super) called: bool,
}

impl Ready {
    /// The state before the first poll.
    pub(super) const NOTHING: Self =
        Self { socket: PollFlags::empty(), exited: false, printed: false, called: false };

    /// The state to assume without a poll: an answer may have arrived, preceded by output.
    pub(crate) const PERHAPS_ANSWERED: Self =
        Self { socket: PollFlags::IN, exited: false, printed: true, called: false };

    /// Whether something arrived, or the other side hung up.
    pub(super) fn readable(self) -> bool {
        !self.socket.difference(PollFlags::OUT).is_empty()
    }

    /// Whether the socket has room for more of the request.
    pub(super) fn writable(self) -> bool {
        self.socket.contains(PollFlags::OUT)
    }

    /// Notes what has happened to one of the descriptors.
    pub(super) fn note(&mut self, source: Source, happened: PollFlags) {
        match source {
            Source::Socket => self.socket = happened,
            Source::Exit => self.exited = !happened.is_empty(),
            Source::Output => self.printed = !happened.is_empty(),
            Source::Calls => self.called = happened.contains(PollFlags::IN),
        }
    }
}
