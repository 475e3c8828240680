//! A file sink that reports its state.
//!
//! The SDK's own file sink truncates existing files, loses the first write error together with its thread, and can
//! hang when the stream is dropped afterwards. This sink never overwrites a file, never blocks the SDK after an
//! error, keeps data that could not be written, and counts the bytes handed to the system.

use crate::{backlog::Backlog, error::RecordingError, file::FileWatch, rr};
use sha2::{Digest, Sha256};
use std::{
    io::{self, Write},
    path::Path,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    time::Duration,
};

/// Limit of the data that is kept while the file cannot be written, bytes: more than an hour of mission time.
const MOST_WAITING_BYTES: usize = 32 << 20;

/// State of the file of a recording; can be read at any time without waiting.
#[derive(Debug, Default)]
pub struct SinkHealth {
    bytes: AtomicU64,
    has_ended: AtomicBool,
    error: Mutex<Option<String>>,
    /// Digest of all data, written or not.
    hasher: Mutex<Sha256>,
}

impl SinkHealth {
    /// Number of bytes handed to the system.
    pub fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }

    /// The reason why the file currently cannot be written, in the words of the system; `None` if it can.
    pub fn error(&self) -> Option<String> {
        self.lock().clone()
    }

    /// Whether data is lost, so that no more is written.
    pub fn has_ended(&self) -> bool {
        self.has_ended.load(Ordering::Relaxed)
    }

    /// SHA-256 of the written data, hexadecimal; `None` unless all of it was written.
    pub(crate) fn sha256(&self) -> String {
        hex::encode(self.hasher().clone().finalize())
    }

    fn hasher(&self) -> MutexGuard<'_, Sha256> {
        self.hasher.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn lock(&self) -> MutexGuard<'_, Option<String>> {
        self.error.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn update(&self, backlog: &Backlog) {
        self.bytes.store(backlog.written_bytes(), Ordering::Relaxed);
        if self.has_ended() {
            return;
        }
        *self.lock() = backlog.trouble().map(str::to_owned);
        self.has_ended.store(backlog.has_ended(), Ordering::Relaxed);
    }

    /// Stops the writing for a reason other than a file error. Only the first reason is kept.
    fn fail(&self, error: &impl ToString) {
        if !self.has_ended.swap(true, Ordering::Relaxed) {
            *self.lock() = Some(error.to_string());
        }
    }
}

/// A writer that never fails, so that the SDK above it never waits or panics.
struct Guarded {
    backlog: Backlog,
    health: Arc<SinkHealth>,
}

impl Guarded {
    fn drain(&mut self) {
        self.backlog.drain();
        self.health.update(&self.backlog);
    }
}

impl Write for Guarded {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if !self.health.has_ended() {
            self.health.hasher().update(bytes);
            self.backlog.waiting().extend_from_slice(bytes);
            self.drain();
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if !self.health.has_ended() {
            self.drain();
        }
        Ok(())
    }
}

/// The sink; encodes data on the SDK's thread.
pub(crate) struct SafeSink {
    encoder: Mutex<rr::Encoder<Guarded>>,
    health: Arc<SinkHealth>,
}

impl SafeSink {
    /// Creates a file and writes the header of the format to it.
    pub(crate) fn create(path: &Path) -> Result<(Self, FileWatch), RecordingError> {
        let failed = |why| RecordingError::Create { why, path: path.to_owned() };
        let (file, watch) = FileWatch::create(path).map_err(|error| failed(error.to_string()))?;
        let sink = Self::writing_to(Box::new(file))?;
        match sink.health.error() {
            Some(error) => Err(failed(error)),
            None => Ok((sink, watch)),
        }
    }

    /// A sink that writes to any writer.
    pub(crate) fn writing_to(out: Box<dyn Write + Send>) -> Result<Self, RecordingError> {
        let health = Arc::new(SinkHealth::default());
        let backlog = Backlog::new(out, MOST_WAITING_BYTES);
        let guarded = Guarded { backlog, health: Arc::clone(&health) };
        let options = rr::EncodingOptions::PROTOBUF_COMPRESSED;
        let mut encoder = rr::Encoder::new_eager(rr::CrateVersion::LOCAL, options, guarded)
            .map_err(|error| RecordingError::sdk(&error))?;
        // The table of contents would be kept in memory until the end: 80 MB for a run of seven hours. Readers work
        // without it, as with a recording that was cut off. Merging the chunks adds a table that is small.
        encoder.do_not_emit_footer();
        Ok(Self { encoder: Mutex::new(encoder), health })
    }

    /// State of the file, even after the sink is dropped.
    pub(crate) fn health(&self) -> Arc<SinkHealth> {
        Arc::clone(&self.health)
    }

    fn encoder(&self) -> MutexGuard<'_, rr::Encoder<Guarded>> {
        self.encoder.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl rr::LogSink for SafeSink {
    fn send(&self, message: rr::LogMsg) {
        if self.health.has_ended() {
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
        // Data that only waits for space is not a failure to the SDK: nothing is lost.
        let lost = self.health.error().filter(|_| self.health.has_ended());
        lost.map_or(Ok(()), |error| Err(rr::SinkFlushError::failed(error)))
    }

    fn defers_finalization_to_shutdown(&self) -> bool {
        true
    }
}
