//! Writing the journal.

use super::{JournalError, packer::Packer};
use crate::{
    backlog::Backlog,
    file::{FileChange, FileWatch},
    identity::hexadecimal,
};
use mission::Event;
use sha2::{Digest, Sha256};
use std::{
    fs::File,
    io::{self, Write},
    path::Path,
    time::{Duration, Instant},
};

/// Unwritten events are handed to the system at the latest after this time,
const FLUSH_AFTER: Duration = Duration::from_millis(500);
/// or when they take this many bytes.
const FLUSH_BYTES: usize = 64 * 1024;
/// Events that are kept while the file cannot be written, bytes: about 40 minutes of mission time.
const MOST_WAITING_BYTES: usize = 4 << 20;

/// Writes a journal.
///
/// Events are gathered, compressed and handed to the operating system at least every half second or 64 kB, so that a process
/// that is killed loses no more than that. The deadline is looked at with every event and by [`JournalWriter::tick`]. So the
/// lines of equal runs are equal, and where the compressed ones are divided depends on the clock.
///
/// What cannot be written, because the disk is full, is kept and tried again every half second: the journal then is
/// whole in the end. When more than 4 MB wait, the journal has ended; events after that are not written.
pub struct JournalWriter {
    backlog: Backlog,
    /// None if nothing is written.
    packer: Option<Packer>,
    file: Option<(File, FileWatch)>,
    line: Vec<u8>,
    /// Of the lines.
    hasher: Sha256,
    /// Of the file.
    file_hasher: Sha256,
    events: u64,
    flushed_at: Instant,
    /// An event that cannot be written as JSON, or not compressed, ends the journal.
    unwritable: Option<String>,
    reported: Option<JournalError>,
}

/// What is known about a journal when it is closed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JournalEnd {
    /// SHA-256 of all its lines, hexadecimal; equal for equal runs.
    pub events_sha256: String,
    /// How many events it holds.
    pub events: u64,
    /// How many bytes the file has.
    pub bytes: u64,
}

impl JournalWriter {
    /// Makes a journal where there is none.
    ///
    /// # Errors
    /// [`JournalError::Create`] if the file exists or cannot be made.
    pub fn create(path: &Path, now: Instant) -> Result<Self, JournalError> {
        let failed =
            |error: io::Error| JournalError::Create { why: error.to_string(), path: path.to_owned() };
        let (file, watch) = FileWatch::create(path).map_err(failed)?;
        let kept = file.try_clone().map_err(failed)?;
        Ok(Self { file: Some((kept, watch)), ..Self::writing_to(Box::new(file), now).map_err(failed)? })
    }

    /// A journal that is written nowhere and only counted and hashed.
    pub fn unwritten(now: Instant) -> Self {
        Self::new(Box::new(io::sink()), None, now)
    }

    /// A journal that goes to any writer, compressed.
    ///
    /// # Errors
    /// The compressor has no memory.
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

    /// The file that is written, to have it put on disk by somebody else; none if there is none.
    pub(crate) fn file(&self) -> Option<&File> {
        self.file.as_ref().map(|(file, _)| file)
    }

    /// Adds an event; does nothing after the journal has ended.
    ///
    /// # Errors
    /// As [`JournalWriter::tick`].
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

    /// Hands waiting events to the system if it is time; to be called now and then while nothing happens.
    ///
    /// # Errors
    /// Once when the journal cannot be written ([`JournalError::Stalled`]), and once when it has ended
    /// ([`JournalError::Write`]).
    pub fn tick(&mut self, now: Instant) -> Result<(), JournalError> {
        let holds_back = self.packer.as_ref().is_some_and(Packer::holds_back);
        let is_waiting = holds_back || self.backlog.waiting_bytes() > 0;
        // A full disk is asked again now and then, not with every event.
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

    /// Hands everything to the system and closes the journal.
    ///
    /// # Errors
    /// [`JournalError::Write`], also if it has been reported before: the journal is not whole.
    /// [`JournalError::Changed`] if the file on disk is not the one that was written, or has another length.
    pub fn finish(mut self) -> Result<JournalEnd, JournalError> {
        self.pack(Packer::end_frame);
        self.backlog.drain();
        let bytes = self.written_bytes();
        if let Some(why) = self.unwritable.as_deref().or(self.backlog.trouble()) {
            return Err(JournalError::Write { bytes, why: why.to_owned() });
        }
        let [events_sha256, file_sha256] =
            [self.hasher, self.file_hasher].map(|hasher| hexadecimal(&hasher.finalize()));
        self.file.map_or(Ok(()), |(_, watch)| watch.check_content(bytes, &file_sha256))?;
        Ok(JournalEnd { events_sha256, events: self.events, bytes })
    }

    /// Has the packer append to what waits; without memory for that the journal ends.
    fn pack(&mut self, step: impl FnOnce(&mut Packer, &mut Vec<u8>) -> io::Result<()>) {
        let Some(packer) = &mut self.packer else { return };
        let waiting = self.backlog.waiting();
        let start = waiting.len();
        match step(packer, waiting) {
            Ok(()) => self.file_hasher.update(&waiting[start..]),
            Err(error) => self.unwritable = Some(format!("it cannot be compressed: {error}")),
        }
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
        self.file.as_ref().map_or(Ok(()), |(_, watch)| watch.check(self.written_bytes()))
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
