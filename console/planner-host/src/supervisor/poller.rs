//! The only place where the console waits for workers: a single `poll(2)` over all of them.

use super::ready::Ready;
use super::waker::WakeReceiver;
use super::worker::Worker;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use std::time::{Duration, Instant};

/// The number of descriptors that two workers and the wake-ups need.
const MOST_USUALLY: usize = 7;

/// Waits until something happens to a worker, a worker must be checked, the host is woken, or the time limit is
/// reached, whichever comes first. Notes what has happened to each worker, in the order of the workers. Returns whether
/// the host was woken; each wake-up is reported once.
pub(crate) fn wait<'a>(
    wake_ups: Option<&WakeReceiver>,
    workers: impl Iterator<Item = &'a Worker> + Clone,
    until: Option<Instant>,
    ready: &mut Vec<Ready>,
) -> bool {
    ready.clear();
    let mut watched = Vec::with_capacity(MOST_USUALLY);
    let wake_up = wake_ups.and_then(WakeReceiver::descriptor);
    watched.extend(wake_up.iter().map(|wake_up| PollFd::from_borrowed_fd(*wake_up, PollFlags::IN)));
    let mut wake_at = until;
    for worker in workers.clone() {
        ready.push(Ready::NOTHING);
        worker.watched(|(_, descriptor, flags)| watched.push(PollFd::from_borrowed_fd(descriptor, flags)));
        wake_at = worker.wake_at().into_iter().chain(wake_at).min();
    }
    // From here to the poll, nothing may be read from the wake-up socket.
    let woken = wake_ups.is_some_and(WakeReceiver::take);
    let left = wake_at.map(|at| at.saturating_duration_since(Instant::now()));
    let left = if woken { Some(Duration::ZERO) } else { left };
    let timeout = left.and_then(|left| Timespec::try_from(left).ok());
    // After a signal or a timeout, nothing has happened; the caller checks the clock and waits again.
    if !matches!(poll(&mut watched, timeout.as_ref()), Ok(1..)) {
        return woken;
    }
    let (wake_up, of_workers) = watched.split_at(usize::from(wake_up.is_some()));
    let mut happened = of_workers.iter().map(PollFd::revents);
    for (worker, ready) in workers.zip(ready) {
        worker.watched(|(source, ..)| ready.note(source, happened.next().unwrap_or(PollFlags::empty())));
    }
    let is_interrupted = wake_up.iter().any(|wake_up| !wake_up.revents().is_empty());
    woken
        | wake_ups.filter(|_| is_interrupted).is_some_and(|wake_ups| {
            wake_ups.empty_socket();
            wake_ups.take()
        })
}

/// Waits for one worker.
pub(crate) fn wait_for_one(worker: &Worker, until: Option<Instant>) -> Ready {
    let mut ready = Vec::with_capacity(1);
    wait(None, std::iter::once(worker), until, &mut ready);
    ready[0]
}
