//! The one place where the console waits for workers: a single `poll(2)` over all of them.

use super::waker::WakeReceiver;
use super::worker::Worker;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use std::os::fd::BorrowedFd;
use std::time::Instant;

/// What a worker's descriptor is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    /// Answers, and room for requests.
    Socket,
    /// The end of the process.
    Exit,
    /// What it prints.
    Output,
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
}

impl Ready {
    const NOTHING: Self = Self { socket: PollFlags::empty(), exited: false, printed: false };

    /// Something arrived, or the other side hung up.
    pub(super) fn readable(self) -> bool {
        !self.socket.difference(PollFlags::OUT).is_empty()
    }

    /// There is room for more of the request.
    pub(super) fn writable(self) -> bool {
        self.socket.contains(PollFlags::OUT)
    }

    fn note(&mut self, source: Source, happened: PollFlags) {
        match source {
            Source::Socket => self.socket = happened,
            Source::Exit => self.exited = !happened.is_empty(),
            Source::Output => self.printed = !happened.is_empty(),
        }
    }
}

/// What came of waiting.
#[derive(Debug, Default)]
pub(crate) struct Happened {
    /// Whether the host was woken; the wake-up is cleared.
    pub(crate) woken: bool,
    /// What has happened to the workers, in their order.
    pub(crate) ready: Vec<Ready>,
}

/// Waits until something happens to a worker, a worker has to be looked at, the host is woken, or the given time is
/// reached, whichever comes first.
pub(crate) fn wait(wake_ups: Option<&WakeReceiver>, workers: &[&Worker], until: Option<Instant>) -> Happened {
    let mut watched = Vec::with_capacity(1 + 3 * workers.len());
    let mut owners = Vec::with_capacity(3 * workers.len());
    let wake_up = wake_ups.and_then(WakeReceiver::descriptor);
    watched.extend(wake_up.iter().map(|wake_up| PollFd::from_borrowed_fd(*wake_up, PollFlags::IN)));
    for (index, worker) in workers.iter().enumerate() {
        worker.watched(|(source, descriptor, flags)| {
            watched.push(PollFd::from_borrowed_fd(descriptor, flags));
            owners.push((index, source));
        });
    }
    let until = workers.iter().filter_map(|worker| worker.wake_at()).chain(until).min();
    let left = until.map(|until| until.saturating_duration_since(Instant::now()));
    let timeout = left.and_then(|left| Timespec::try_from(left).ok());
    let mut ready = vec![Ready::NOTHING; workers.len()];
    // After a signal or a timeout nothing has happened: the caller checks the clock and waits again.
    if !matches!(poll(&mut watched, timeout.as_ref()), Ok(1..)) {
        return Happened { woken: false, ready };
    }
    let (wake_up, of_workers) = watched.split_at(usize::from(wake_up.is_some()));
    for (descriptor, (index, source)) in of_workers.iter().zip(owners) {
        ready[index].note(source, descriptor.revents());
    }
    let woken = wake_up.iter().any(|wake_up| !wake_up.revents().is_empty());
    if let Some(wake_ups) = wake_ups.filter(|_| woken) {
        wake_ups.clear();
    }
    Happened { woken, ready }
}
