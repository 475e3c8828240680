//! Wakes the thread that is waiting for planners.
//!
//! A flag states whether a wake-up is pending; the socket only ends a wait that has already begun. A sender first sets
//! the flag and then writes a byte to the socket. Before the receiver waits, it checks that the flag is cleared, and it
//! does not read from the socket between this check and the wait. If a sender sets the flag after the check, its byte
//! therefore ends the wait. If the receiver clears the flag before the sender has written, the byte stays in the socket
//! and ends a later wait too early, which does no harm.

use std::io::{Read, Write};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Makes the current or the next call of [`Host::next`](crate::Host::next) return once without an answer. It can be
/// used from any thread; multiple pending wake-ups have the effect of one.
#[derive(Debug, Clone)]
pub struct Waker(Arc<Sender>);

#[derive(Debug)]
struct Sender {
    is_pending: AtomicBool,
    /// `None` if the system has no descriptors left; in that case no worker can be started, and nothing ever waits.
    socket: Option<UnixStream>,
}

impl Waker {
    /// Wakes the host; never blocks.
    pub fn wake(&self) {
        let was_pending = self.0.is_pending.swap(true, Ordering::AcqRel);
        if let Some(mut socket) = self.0.socket.as_ref().filter(|_| !was_pending) {
            // A full socket ends the wait anyway, and without a host there is nothing to wake.
            let _ = socket.write(&[1]);
        }
    }
}

/// The receiving end of a [`Waker`].
pub(crate) struct WakeReceiver {
    waker: Waker,
    socket: Option<UnixStream>,
}

impl WakeReceiver {
    /// Creates a receiver without pending wake-ups.
    pub(crate) fn new() -> Self {
        let pair = UnixStream::pair().and_then(|(sender, receiver)| {
            sender.set_nonblocking(true)?;
            receiver.set_nonblocking(true)?;
            Ok((sender, receiver))
        });
        let (sender, socket) = pair.ok().unzip();
        let sender = Sender { is_pending: AtomicBool::new(false), socket: sender };
        Self { waker: Waker(Arc::new(sender)), socket }
    }

    /// Returns the sending end.
    pub(crate) fn waker(&self) -> Waker {
        self.waker.clone()
    }

    /// Drops pending wake-ups and returns whether there were any. Makes no system call if there were none.
    pub(crate) fn take(&self) -> bool {
        let was_pending = self.waker.0.is_pending.swap(false, Ordering::AcqRel);
        if was_pending {
            self.empty_socket();
        }
        was_pending
    }

    /// Reads everything that wake-ups have written; a pending wake-up stays pending.
    pub(super) fn empty_socket(&self) {
        let mut bytes = [0; 64];
        if let Some(mut socket) = self.socket.as_ref() {
            while socket.read(&mut bytes).is_ok_and(|n| n == bytes.len()) {}
        }
    }

    /// Returns the descriptor that becomes readable when a wake-up arrives during a wait.
    pub(super) fn descriptor(&self) -> Option<BorrowedFd<'_>> {
        self.socket.as_ref().map(AsFd::as_fd)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::supervisor::poller::wait;
    use std::thread::spawn;
    use std::time::{Duration, Instant};

    /// Waits for a wake-up, however long a busy machine takes.
    fn is_woken(wake_ups: &WakeReceiver) -> bool {
        is_woken_until(wake_ups, Instant::now() + Duration::from_mins(1))
    }

    fn is_woken_until(wake_ups: &WakeReceiver, until: Instant) -> bool {
        loop {
            let woken = wait(Some(wake_ups), std::iter::empty(), Some(until), &mut Vec::new());
            if woken || Instant::now() >= until {
                return woken;
            }
        }
    }

    #[test]
    fn pending_wake_ups_count_as_one() {
        let wake_ups = WakeReceiver::new();
        let is_woken_now = || is_woken_until(&wake_ups, Instant::now());
        assert!(!is_woken_now());
        (0..3).for_each(|_| wake_ups.waker().wake());
        assert!(is_woken_now() && !is_woken_now());
        wake_ups.waker().wake();
        assert!(wake_ups.take() && !wake_ups.take() && !is_woken_now());
    }

    #[test]
    fn a_wake_up_that_comes_while_an_earlier_one_is_taken_is_not_lost() {
        let wake_ups = WakeReceiver::new();
        wake_ups.waker().wake();
        // The steps of `take`, with a wake-up between them.
        assert!(wake_ups.waker.0.is_pending.swap(false, Ordering::AcqRel));
        wake_ups.waker().wake();
        wake_ups.empty_socket();
        wake_ups.waker().wake();
        assert!(is_woken(&wake_ups));
    }

    #[test]
    fn a_wake_up_that_is_taken_before_it_has_written_wakes_nobody_afterwards() {
        let wake_ups = WakeReceiver::new();
        let Sender { is_pending, socket } = &*wake_ups.waker.0;
        // The steps of `wake`, with the receiver's `take` between them.
        is_pending.store(true, Ordering::Release);
        assert!(wake_ups.take());
        assert_eq!(socket.as_ref().expect("a socket").write(&[1]).expect("written"), 1);
        assert!(!is_woken_until(&wake_ups, Instant::now() + Duration::from_millis(5)));
        wake_ups.waker().wake();
        assert!(is_woken(&wake_ups));
    }

    /// Threads make a request, wake the receiver, and continue when the request has been granted. If a wake-up is
    /// lost, all of them end up waiting for each other.
    #[test]
    fn no_wake_up_is_lost() {
        const N_THREADS: usize = 4;
        const N_EACH: u32 = 20_000;
        let wake_ups = WakeReceiver::new();
        let asked: Arc<[AtomicBool; N_THREADS]> = Arc::default();
        for index in 0..N_THREADS {
            let (asked, waker) = (Arc::clone(&asked), wake_ups.waker());
            spawn(move || {
                for _ in 0..N_EACH {
                    asked[index].store(true, Ordering::Release);
                    waker.wake();
                    while asked[index].load(Ordering::Acquire) {
                        std::thread::yield_now();
                    }
                }
            });
        }
        let mut n_given = 0;
        while n_given < N_THREADS as u32 * N_EACH {
            // The console does the same before it looks for orders: a thread whose wake-up is dropped here has already
            // made its request.
            if n_given % 3 > 0 || !wake_ups.take() {
                assert!(
                    is_woken(&wake_ups),
                    "the receiver was not woken after {n_given} requests had been granted"
                );
            }
            n_given += asked.iter().map(|asked| u32::from(asked.swap(false, Ordering::AcqRel))).sum::<u32>();
        }
    }
}
