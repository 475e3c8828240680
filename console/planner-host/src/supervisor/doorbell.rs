//! Wakes the thread that waits for planners.

use std::io::{Read, Write};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::net::UnixStream;
use std::sync::Arc;

/// Makes the current or the next [`Host::next`](crate::Host::next) return without an answer, once. May be rung from any
/// thread; rings that nobody has heard yet count as one.
#[derive(Debug, Clone)]
pub struct Doorbell(Option<Arc<UnixStream>>);

impl Doorbell {
    /// Rings; never waits.
    pub fn ring(&self) {
        if let Some(mut button) = self.0.as_deref() {
            // A full socket has been rung often enough, and without a host nobody has to be woken.
            let _ = button.write(&[1]);
        }
    }
}

/// The other end of a doorbell.
pub(crate) struct Bell {
    button: Doorbell,
    /// Absent when the system has no descriptors left; then no worker can be started, and nobody ever waits.
    line: Option<UnixStream>,
}

impl Bell {
    /// A bell that was not rung.
    pub(crate) fn new() -> Self {
        let pair = UnixStream::pair().and_then(|(button, line)| {
            button.set_nonblocking(true)?;
            line.set_nonblocking(true)?;
            Ok((button, line))
        });
        let (button, line) = pair.ok().unzip();
        Self { button: Doorbell(button.map(Arc::new)), line }
    }

    /// Who may ring.
    pub(crate) fn button(&self) -> Doorbell {
        self.button.clone()
    }

    /// Forgets that it was rung.
    pub(crate) fn clear(&self) {
        let mut rings = [0; 64];
        if let Some(mut line) = self.line.as_ref() {
            while let Ok(1..) = line.read(&mut rings) {}
        }
    }

    /// Readable once it was rung.
    pub(super) fn line(&self) -> Option<BorrowedFd<'_>> {
        self.line.as_ref().map(AsFd::as_fd)
    }
}
