//! Wakes the thread that waits for planners.

use std::io::{Read, Write};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::net::UnixStream;
use std::sync::Arc;

/// Makes the current or the next [`Host::next`](crate::Host::next) return without an answer, once. Can be used from any
/// thread; pending wake-ups count as one.
#[derive(Debug, Clone)]
pub struct Waker(Option<Arc<UnixStream>>);

impl Waker {
    /// Wakes the host; never blocks.
    pub fn wake(&self) {
        if let Some(mut sender) = self.0.as_deref() {
            // A full socket already holds a wake-up, and without a host nothing has to be woken.
            let _ = sender.write(&[1]);
        }
    }
}

/// The receiving end of a [`Waker`].
pub(crate) struct WakeReceiver {
    waker: Waker,
    /// Absent when the system has no descriptors left; then no worker can be started, and nobody ever waits.
    socket: Option<UnixStream>,
}

impl WakeReceiver {
    /// No wake-up is pending.
    pub(crate) fn new() -> Self {
        let pair = UnixStream::pair().and_then(|(sender, receiver)| {
            sender.set_nonblocking(true)?;
            receiver.set_nonblocking(true)?;
            Ok((sender, receiver))
        });
        let (sender, socket) = pair.ok().unzip();
        Self { waker: Waker(sender.map(Arc::new)), socket }
    }

    /// The sending end.
    pub(crate) fn waker(&self) -> Waker {
        self.waker.clone()
    }

    /// Drops pending wake-ups.
    pub(crate) fn clear(&self) {
        let mut bytes = [0; 64];
        if let Some(mut socket) = self.socket.as_ref() {
            while let Ok(1..) = socket.read(&mut bytes) {}
        }
    }

    /// Readable while a wake-up is pending.
    pub(super) fn descriptor(&self) -> Option<BorrowedFd<'_>> {
        self.socket.as_ref().map(AsFd::as_fd)
    }
}
