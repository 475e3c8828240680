//! A file sink that tells how it is.
//!
//! The SDK's own file sink truncates existing files, loses the first write error with its thread, and can hang when
//! the stream is dropped afterwards. This one never writes over a file, never blocks the SDK after an error, and
//! counts the bytes that reached the system.

use crate::{error::RecordingError, rr};
use std::{
    fs::OpenOptions,
    io::{self, Write},
    path::Path,
    sync::{
        Arc, Mutex, MutexGuard, OnceLock, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
    time::Duration,
};

/// How the file of a recording is doing; can be read at any time without waiting.
#[derive(Debug, Default)]
pub struct SinkHealth {
    bytes: AtomicU64,
    error: OnceLock<String>,
}

impl SinkHealth {
    /// How many bytes the system has got.
    pub fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }

    /// The first error, in the words of the system.
    pub fn error(&self) -> Option<&str> {
        self.error.get().map(String::as_str)
    }

    fn fail(&self, error: &impl ToString) {
        // Only the first error tells what happened; the others follow from it.
        let _ = self.error.set(error.to_string());
    }
}

/// A writer that swallows everything after its first error, so that the SDK above it never waits or panics.
struct Guarded {
    out: Box<dyn Write + Send>,
    health: Arc<SinkHealth>,
}

impl Write for Guarded {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.write_all(bytes)?;
        Ok(bytes.len())
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        if self.health.error().is_none() {
            match self.out.write_all(bytes) {
                Ok(()) => drop(self.health.bytes.fetch_add(bytes.len() as u64, Ordering::Relaxed)),
                Err(error) => self.health.fail(&error),
            }
        }
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.health.error().is_none()
            && let Err(error) = self.out.flush()
        {
            self.health.fail(&error);
        }
        Ok(())
    }
}

/// The sink; encodes on the SDK's thread.
pub(crate) struct SafeSink {
    encoder: Mutex<rr::Encoder<Guarded>>,
    health: Arc<SinkHealth>,
}

impl SafeSink {
    /// Makes a file where there is none, and writes the head of the format to it.
    pub(crate) fn create(path: &Path) -> Result<Self, RecordingError> {
        let failed = |why| RecordingError::Create { why, path: path.to_owned() };
        let file = OpenOptions::new().write(true).create_new(true).open(path);
        let sink = Self::writing_to(Box::new(file.map_err(|error| failed(error.to_string()))?))?;
        match sink.health.error() {
            Some(error) => Err(failed(error.to_owned())),
            None => Ok(sink),
        }
    }

    /// A sink over any writer.
    pub(crate) fn writing_to(out: Box<dyn Write + Send>) -> Result<Self, RecordingError> {
        let health = Arc::new(SinkHealth::default());
        let guarded = Guarded { out, health: Arc::clone(&health) };
        let options = rr::EncodingOptions::PROTOBUF_COMPRESSED;
        let encoder = rr::Encoder::new_eager(rr::CrateVersion::LOCAL, options, guarded);
        Ok(Self { encoder: Mutex::new(encoder.map_err(|error| RecordingError::sdk(&error))?), health })
    }

    /// How the file is doing, also after the sink is gone.
    pub(crate) fn health(&self) -> Arc<SinkHealth> {
        Arc::clone(&self.health)
    }

    fn encoder(&self) -> MutexGuard<'_, rr::Encoder<Guarded>> {
        self.encoder.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl rr::LogSink for SafeSink {
    fn send(&self, message: rr::LogMsg) {
        if self.health.error().is_some() {
            return;
        }
        if let Err(error) = self.encoder().append(&message) {
            self.health.fail(&error);
        }
    }

    fn flush_blocking(&self, _timeout: Duration) -> Result<(), rr::SinkFlushError> {
        if let Err(error) = self.encoder().flush_blocking() {
            self.health.fail(&error);
        }
        self.health.error().map_or(Ok(()), |error| Err(rr::SinkFlushError::failed(error)))
    }

    fn defers_finalization_to_shutdown(&self) -> bool {
        true
    }
}
