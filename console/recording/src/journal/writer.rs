//! Writing the journal.

use super::JournalError;
use crate::identity::hexadecimal;
use mission::Event;
use sha2::{Digest, Sha256};
use std::{
    fs::OpenOptions,
    io::{self, Write},
    path::Path,
    time::{Duration, Instant},
};

/// Unwritten events are handed to the system at the latest after this time,
const FLUSH_AFTER: Duration = Duration::from_millis(500);
/// or when they take this many bytes.
const FLUSH_BYTES: usize = 64 * 1024;

/// Writes a journal.
///
/// Events are gathered and handed to the operating system at least every half second or 64 kB, so that a process
/// that is killed loses no more than that. The deadline is looked at with every event and by [`JournalWriter::tick`].
/// The first write error is told once and ends the journal; events after it are not written.
pub struct JournalWriter {
    out: Box<dyn Write + Send>,
    pending: Vec<u8>,
    hasher: Sha256,
    events: u64,
    written_bytes: u64,
    flushed_at: Instant,
    error: Option<JournalError>,
}

/// What is known about a journal when it is closed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JournalEnd {
    /// SHA-256 of all its bytes, hexadecimal; equal for equal runs.
    pub events_sha256: String,
    /// How many events it holds.
    pub events: u64,
    /// How many bytes it has.
    pub bytes: u64,
}

impl JournalWriter {
    /// Makes a journal where there is none.
    ///
    /// # Errors
    /// [`JournalError::Create`] if the file exists or cannot be made.
    pub fn create(path: &Path, now: Instant) -> Result<Self, JournalError> {
        let file = OpenOptions::new().write(true).create_new(true).open(path);
        let file =
            file.map_err(|error| JournalError::Create { why: error.to_string(), path: path.to_owned() })?;
        Ok(Self::writing_to(Box::new(file), now))
    }

    /// A journal that is written nowhere and only counted and hashed.
    pub fn unwritten(now: Instant) -> Self {
        Self::writing_to(Box::new(io::sink()), now)
    }

    /// A journal that goes to any writer.
    pub fn writing_to(out: Box<dyn Write + Send>, now: Instant) -> Self {
        let pending = Vec::with_capacity(2 * FLUSH_BYTES);
        Self {
            out,
            pending,
            hasher: Sha256::new(),
            events: 0,
            written_bytes: 0,
            flushed_at: now,
            error: None,
        }
    }

    /// Adds an event; does nothing after an error.
    ///
    /// # Errors
    /// [`JournalError::Write`], once.
    pub fn append(&mut self, event: &Event, now: Instant) -> Result<(), JournalError> {
        if self.error.is_some() {
            return Ok(());
        }
        let start = self.pending.len();
        if let Err(error) = serde_json::to_writer(&mut self.pending, event) {
            self.pending.truncate(start);
            return self.fail(&error);
        }
        self.pending.push(b'\n');
        self.hasher.update(&self.pending[start..]);
        self.events += 1;
        self.tick(now)
    }

    /// Hands waiting events to the system if it is time; to be called now and then while nothing happens.
    ///
    /// # Errors
    /// [`JournalError::Write`], once.
    pub fn tick(&mut self, now: Instant) -> Result<(), JournalError> {
        let due = self.pending.len() >= FLUSH_BYTES
            || (!self.pending.is_empty() && now.saturating_duration_since(self.flushed_at) >= FLUSH_AFTER);
        if !due {
            return Ok(());
        }
        self.flushed_at = now;
        self.flush()
    }

    /// Hands everything to the system and closes the journal.
    ///
    /// # Errors
    /// [`JournalError::Write`], also if it has been told before: the journal is not whole.
    pub fn finish(mut self) -> Result<JournalEnd, JournalError> {
        self.flush()?;
        match self.error {
            Some(error) => Err(error),
            None => Ok(JournalEnd {
                events_sha256: hexadecimal(&self.hasher.finalize()),
                events: self.events,
                bytes: self.written_bytes,
            }),
        }
    }

    /// How many bytes the system has got.
    pub fn written_bytes(&self) -> u64 {
        self.written_bytes
    }

    fn flush(&mut self) -> Result<(), JournalError> {
        if self.error.is_some() {
            return Ok(());
        }
        match self.out.write_all(&self.pending).and_then(|()| self.out.flush()) {
            Ok(()) => {
                self.written_bytes += self.pending.len() as u64;
                self.pending.clear();
                Ok(())
            }
            Err(error) => self.fail(&error),
        }
    }

    fn fail(&mut self, why: &impl ToString) -> Result<(), JournalError> {
        let error = JournalError::Write { bytes: self.written_bytes, why: why.to_string() };
        self.error = Some(error.clone());
        self.pending = Vec::new();
        Err(error)
    }
}
