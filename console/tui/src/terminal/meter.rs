//! Measures how long writing to the terminal has to wait.

use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// What was sent since the meter was last read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sent {
    /// The number of bytes.
    pub bytes: usize,
    /// How long writing them took: longer than a moment if the line had to take earlier bytes first.
    pub took: Duration,
}

/// The meter of a line, shared by the output and the terminal that owns it.
#[derive(Debug, Clone)]
pub(super) struct Meter {
    sent: Arc<Mutex<Sent>>,
    is_slow: Arc<AtomicBool>,
    /// A clock that never goes back.
    clock: fn() -> Duration,
}

impl Meter {
    /// A meter that reads the given clock, which never goes back.
    pub(super) fn new(clock: fn() -> Duration) -> Self {
        Self { sent: Arc::default(), is_slow: Arc::default(), clock }
    }

    /// What was sent since the last call.
    pub(super) fn take(&self) -> Sent {
        std::mem::take(&mut *self.sent.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Whether the line is slow: a frame is then shown while it arrives, and not only when it is complete.
    pub(super) fn is_slow(&self) -> bool {
        self.is_slow.load(Ordering::Relaxed)
    }

    /// Sets whether the line is slow.
    pub(super) fn set_slow(&self, is_slow: bool) {
        self.is_slow.store(is_slow, Ordering::Relaxed);
    }

    /// Writes bytes and measures how long that takes.
    pub(super) fn write(&self, to: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
        let began = (self.clock)();
        to.write_all(bytes)?;
        to.flush()?;
        let mut sent = self.sent.lock().unwrap_or_else(PoisonError::into_inner);
        sent.bytes += bytes.len();
        sent.took += (self.clock)().saturating_sub(began);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicU64;

    /// A clock that goes on by a second each time it is read.
    fn clock() -> Duration {
        static READ: AtomicU64 = AtomicU64::new(0);
        Duration::from_secs(READ.fetch_add(1, Ordering::Relaxed))
    }

    #[test]
    fn bytes_and_times_add_up_until_they_are_read() {
        let meter = Meter::new(clock);
        let mut line = Vec::new();
        for part in [b"one".as_slice(), b"two"] {
            meter.write(&mut line, part).expect("memory");
        }
        assert_eq!(meter.take(), Sent { bytes: 6, took: Duration::from_secs(2) });
        assert_eq!((meter.take(), line.as_slice()), (Sent::default(), b"onetwo".as_slice()));
    }
}
