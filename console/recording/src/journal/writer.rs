//! Writing the journal.

use super::JournalError;
use crate::{
    backlog::Backlog,
    file::{FileChange, FileWatch},
    identity::hexadecimal,
};
use mission::Event;
use sha2::{Digest, Sha256};
use std::{
    io::{self, Write},
    path::Path,
    time::{Duration, Instant},
};

/// Unwritten events are handed to the system at the latest after this time,
const FLUSH_AFTER: Duration = Duration::from_millis(500);
/// or when they take this many bytes.
const FLUSH_BYTES: usize = 64 * 1024;
/// Events that are kept while the file cannot be written, bytes: about 40 minutes of mission time.
const MOST_WAITING_BYTES: usize = 64 << 20;

/// Writes a journal.
///
/// Events are gathered and handed to the operating system at least every half second or 64 kB, so that a process
/// that is killed loses no more than that. The deadline is looked at with every event and by [`JournalWriter::tick`].
///
/// What cannot be written, because the disk is full, is kept and tried again every half second: the journal then is
/// whole in the end. When more than 64 MB wait, the journal has ended; events after that are not written.
pub struct JournalWriter {
    backlog: Backlog,
    watch: Option<FileWatch>,
    hasher: Sha256,
    events: u64,
    flushed_at: Instant,
    /// An event that cannot be written as JSON ends the journal.
    unwritable: Option<String>,
    reported: Option<JournalError>,
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
        let (file, watch) = FileWatch::create(path)
            .map_err(|error| JournalError::Create { why: error.to_string(), path: path.to_owned() })?;
        Ok(Self { watch: Some(watch), ..Self::writing_to(Box::new(file), now) })
    }

    /// A journal that is written nowhere and only counted and hashed.
    pub fn unwritten(now: Instant) -> Self {
        Self::writing_to(Box::new(io::sink()), now)
    }

    /// A journal that goes to any writer.
    pub fn writing_to(out: Box<dyn Write + Send>, now: Instant) -> Self {
        Self {
            backlog: Backlog::new(out, MOST_WAITING_BYTES),
            watch: None,
            hasher: Sha256::new(),
            events: 0,
            flushed_at: now,
            unwritable: None,
            reported: None,
        }
    }

    /// Adds an event; does nothing after the journal has ended.
    ///
    /// # Errors
    /// As [`JournalWriter::tick`].
    pub fn append(&mut self, event: &Event, now: Instant) -> Result<(), JournalError> {
        if self.has_ended() {
            return Ok(());
        }
        let waiting = self.backlog.waiting();
        let start = waiting.len();
        if let Err(error) = serde_json::to_writer(&mut *waiting, event) {
            waiting.truncate(start);
            self.unwritable = Some(error.to_string());
            return self.report();
        }
        waiting.push(b'\n');
        self.hasher.update(&waiting[start..]);
        self.events += 1;
        self.tick(now)
    }

    /// Hands waiting events to the system if it is time; to be called now and then while nothing happens.
    ///
    /// # Errors
    /// Once when the journal cannot be written ([`JournalError::Stalled`]), and once when it has ended
    /// ([`JournalError::Write`]).
    pub fn tick(&mut self, now: Instant) -> Result<(), JournalError> {
        let is_waiting = self.backlog.waiting_bytes() > 0;
        // A full disk is asked again now and then, not with every event.
        let is_much = self.backlog.waiting_bytes() >= FLUSH_BYTES && self.backlog.trouble().is_none();
        let is_old = now.saturating_duration_since(self.flushed_at) >= FLUSH_AFTER;
        if !(is_much || is_waiting && is_old) {
            return Ok(());
        }
        self.flushed_at = now;
        self.backlog.drain();
        self.report()
    }

    /// Hands everything to the system and closes the journal.
    ///
    /// # Errors
    /// [`JournalError::Write`], also if it has been reported before: the journal is not whole.
    /// [`JournalError::Changed`] if the file on disk is not the one that was written, or has another length.
    pub fn finish(mut self) -> Result<JournalEnd, JournalError> {
        self.backlog.drain();
        let bytes = self.written_bytes();
        if let Some(why) = self.unwritable.as_deref().or(self.backlog.trouble()) {
            return Err(JournalError::Write { bytes, why: why.to_owned() });
        }
        let events_sha256 = hexadecimal(&self.hasher.finalize());
        self.watch.as_ref().map_or(Ok(()), |watch| watch.check_content(bytes, &events_sha256))?;
        Ok(JournalEnd { events_sha256, events: self.events, bytes })
    }

    /// How many bytes the system has got.
    pub fn written_bytes(&self) -> u64 {
        self.backlog.written_bytes()
    }

    /// Why the journal is not being written now; none if it is.
    pub fn trouble(&self) -> Option<JournalError> {
        let bytes = self.written_bytes();
        let stall = self.backlog.trouble().map(|why| JournalError::Stalled { bytes, why: why.to_owned() });
        if !self.has_ended() {
            return stall;
        }
        let why = self.unwritable.as_deref().or(self.backlog.trouble()).unwrap_or_default().to_owned();
        Some(JournalError::Write { bytes, why })
    }

    /// Whether the path still shows the file that is being written.
    ///
    /// # Errors
    /// How it differs.
    pub fn check_file(&self) -> Result<(), FileChange> {
        self.watch.as_ref().map_or(Ok(()), |watch| watch.check(self.written_bytes()))
    }

    fn has_ended(&self) -> bool {
        self.unwritable.is_some() || self.backlog.has_ended()
    }

    /// The trouble there is, if it is another one than was reported.
    fn report(&mut self) -> Result<(), JournalError> {
        let trouble = self.trouble();
        let is_same_kind = trouble.as_ref().map(std::mem::discriminant)
            == self.reported.as_ref().map(std::mem::discriminant);
        self.reported.clone_from(&trouble);
        trouble.filter(|_| !is_same_kind).map_or(Ok(()), Err)
    }
}
