//! Writes the journal.

use super::{JournalError, packer::Packer};
use crate::{
    backlog::Backlog,
    file::{FileChange, FileWatch},
};
use mission::Event;
use sha2::{Digest, Sha256};
use std::{
    fs::File,
    io::{self, Write},
    path::Path,
    time::{Duration, Instant},
};

/// Time after which unwritten events are handed to the system at the latest.
const FLUSH_AFTER: Duration = Duration::from_millis(500);
/// Number of bytes of unwritten events at which they are handed to the system.
const FLUSH_BYTES: usize = 64 * 1024;
/// Limit on the events that are kept while the file cannot be written, bytes: about 40 minutes of mission time.
const MOST_WAITING_BYTES: usize = 4 << 20;

/// Writes a journal.
///
/// Events are collected, compressed and handed to the operating system at least every half second or every 64 kB, so
/// that a killed process loses no more than that. The deadline is checked at every event and by
/// [`JournalWriter::tick`], so the division of the compressed data depends on the clock. The lines themselves do not:
/// equal runs have equal lines.
///
/// Data that cannot be written, for example because the disk is full, is kept, and writing is tried again every half
/// second, so that the journal is complete in the end. If more than 4 MB are waiting, the journal ends; later events
/// are not written.
pub struct JournalWriter {
    backlog: Backlog,
    /// `None` if no file is written.
    packer: Option<Packer>,
    file: Option<(File, FileWatch)>,
    line: Vec<u8>,
    /// Digest of the lines.
    hasher: Sha256,
    /// Digest of the file.
    file_hasher: Sha256,
    events: u64,
    flushed_at: Instant,
    /// The reason why an event cannot be written as JSON or compressed; such an event ends the journal.
    unwritable: Option<String>,
    reported: Option<JournalError>,
}

/// The final data of a closed journal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JournalEnd {
    /// SHA-256 of all lines, hexadecimal; equal for equal runs.
    pub events_sha256: String,
    /// Number of events.
    pub events: u64,
    /// Length of the file, bytes.
    pub bytes: u64,
}

impl JournalWriter {
    /// Creates a journal.
    ///
    /// # Errors
    /// [`JournalError::Create`] if the file exists or cannot be created.
    pub fn create(path: &Path, now: Instant) -> Result<Self, JournalError> {
        let failed =
            |error: io::Error| JournalError::Create { why: error.to_string(), path: path.to_owned() };
        let (file, watch) = FileWatch::create(path).map_err(failed)?;
        let kept = file.try_clone().map_err(failed)?;
        Ok(Self { file: Some((kept, watch)), ..Self::writing_to(Box::new(file), now).map_err(failed)? })
    }

    /// A journal that is only counted and hashed, not written.
    pub fn unwritten(now: Instant) -> Self {
        Self::new(Box::new(io::sink()), None, now)
    }

    /// A compressed journal that is written to any writer.
    ///
    /// # Errors
    /// The compressor cannot allocate memory.
    pub fn writing_to(out: Box<dyn Write + Send>, now: Instant) -> io::Result<Self> {
        Ok(Self::new(out, Some(Packer::new()?), now))
    }

    fn new(out: Box<dyn Write + Send>, packer: Option<Packer>, now: Instant) -> Self {
        Self {
            backlog: Backlog::new(out, MOST_WAITING_BYTES),
            packer,
            file: None,
            line: Vec::new(),
            hasher: Sha256::new(),
            file_hasher: Sha256::new(),
            events: 0,
            flushed_at: now,
            unwritable: None,
            reported: None,
        }
    }

    /// A handle to the file, for a caller that syncs it to disk; `None` if no file is written.
    pub(crate) fn file(&self) -> Option<&File> {
        self.file.as_ref().map(|(file, _)| file)
    }

    /// Adds an event; does nothing after the journal has ended.
    ///
    /// # Errors
    /// See [`JournalWriter::tick`].
    pub fn append(&mut self, event: &Event, now: Instant) -> Result<(), JournalError> {
        if self.has_ended() {
            return Ok(());
        }
        self.line.clear();
        if let Err(error) = serde_json::to_writer(&mut self.line, event) {
            self.unwritable = Some(error.to_string());
            return self.report();
        }
        self.line.push(b'\n');
        self.hasher.update(&self.line);
        self.events += 1;
        let line = std::mem::take(&mut self.line);
        self.pack(|packer, out| packer.add(&line, out));
        self.line = line;
        self.tick(now)
    }

    /// Hands waiting events to the system if they are due; call it regularly while there are no events.
    ///
    /// # Errors
    /// One error when the journal cannot be written ([`JournalError::Stalled`]), and one when it has ended
    /// ([`JournalError::Write`]).
    pub fn tick(&mut self, now: Instant) -> Result<(), JournalError> {
        let holds_back = self.packer.as_ref().is_some_and(Packer::holds_back);
        let is_waiting = holds_back || self.backlog.waiting_bytes() > 0;
        // Writing to a full disk is tried again at intervals, not with every event.
        let is_much = self.backlog.waiting_bytes() >= FLUSH_BYTES && self.backlog.trouble().is_none();
        let is_old = now.saturating_duration_since(self.flushed_at) >= FLUSH_AFTER;
        if is_old {
            self.pack(Packer::flush);
        }
        if !(is_much || is_waiting && is_old) {
            return self.report();
        }
        self.flushed_at = now;
        self.backlog.drain();
        self.report()
    }

    /// Hands all data to the system now, without closing the journal.
    ///
    /// # Errors
    /// See [`JournalWriter::tick`].
    pub fn flush(&mut self, now: Instant) -> Result<(), JournalError> {
        self.pack(Packer::flush);
        self.flushed_at = now;
        self.backlog.drain();
        self.report()
    }

    /// Hands all data to the system and closes the journal.
    ///
    /// # Errors
    /// [`JournalError::Write`], even if it has been reported before: the journal is not complete.
    /// [`JournalError::Changed`] if the file on disk is not the one that was written, or has a different length.
    pub fn finish(mut self) -> Result<JournalEnd, JournalError> {
        self.pack(Packer::end_frame);
        self.backlog.drain();
        let bytes = self.written_bytes();
        if let Some(why) = self.unwritable.as_deref().or(self.backlog.trouble()) {
            return Err(JournalError::Write { bytes, why: why.to_owned() });
        }
        let [events_sha256, file_sha256] =
            [self.hasher, self.file_hasher].map(|hasher| hex::encode(hasher.finalize()));
        self.file.map_or(Ok(()), |(_, watch)| watch.check_content(bytes, &file_sha256))?;
        Ok(JournalEnd { events_sha256, events: self.events, bytes })
    }

    /// Calls `step`, in which the packer appends to the waiting bytes. If the packer lacks memory, the journal ends.
    fn pack(&mut self, step: impl FnOnce(&mut Packer, &mut Vec<u8>) -> io::Result<()>) {
        let Some(packer) = &mut self.packer else { return };
        let waiting = self.backlog.waiting();
        let start = waiting.len();
        match step(packer, waiting) {
            Ok(()) => self.file_hasher.update(&waiting[start..]),
            Err(error) => self.unwritable = Some(format!("it cannot be compressed: {error}")),
        }
    }

    /// Number of bytes handed to the system.
    pub fn written_bytes(&self) -> u64 {
        self.backlog.written_bytes()
    }

    /// The reason why the journal is currently not being written; `None` if it is.
    pub fn trouble(&self) -> Option<JournalError> {
        let bytes = self.written_bytes();
        let stall = self.backlog.trouble().map(|why| JournalError::Stalled { bytes, why: why.to_owned() });
        if !self.has_ended() {
            return stall;
        }
        let why = self.unwritable.as_deref().or(self.backlog.trouble()).unwrap_or_default().to_owned();
        Some(JournalError::Write { bytes, why })
    }

    /// Checks that the path still leads to the file that is being written.
    ///
    /// # Errors
    /// The difference.
    pub fn check_file(&self) -> Result<(), FileChange> {
        self.file.as_ref().map_or(Ok(()), |(_, watch)| watch.check(self.written_bytes()))
    }

    fn has_ended(&self) -> bool {
        self.unwritable.is_some() || self.backlog.has_ended()
    }

    /// The current problem, if it differs from the one last reported.
    fn report(&mut self) -> Result<(), JournalError> {
        let trouble = self.trouble();
        let is_same_kind = trouble.as_ref().map(std::mem::discriminant)
            == self.reported.as_ref().map(std::mem::discriminant);
        self.reported.clone_from(&trouble);
        trouble.filter(|_| !is_same_kind).map_or(Ok(()), Err)
    }
}
