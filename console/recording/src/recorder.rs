//! Writes events to a recording for the rerun viewer.

mod corrosion;
mod document;
mod drawings;
mod figures;
mod fold;
mod lane;
mod layout;
pub(crate) mod paths;
mod ranging;
mod raster;
mod scene;
mod series;
mod states;
pub(crate) mod stream;
pub(crate) mod style;
mod survey;
mod table;
mod tables;
mod tick;

pub(crate) use figures::FIGURES;

use crate::{
    error::RecordingError,
    file::{self, FileChange, FileWatch},
    identity::Identity,
    merge,
    sink::{SafeSink, SinkHealth},
};
use account::Summary;
use fold::Fold;
use mission::{Event, EventKind};
use std::{
    io::Write,
    path::Path,
    sync::Arc,
    time::{Duration, Instant, SystemTime},
};
use stream::Stream;

/// Name of the recording in the folder of a run.
pub const RECORDING_FILE: &str = "recording.rrd";
/// Number of ticks after which rows are sent to the file.
const SEND_TICKS: u32 = 16_384;
/// Number of drawings of planners after which rows are sent to the file; a tick may have thousands of drawings.
const SEND_DRAWINGS: usize = 1 << 19;
/// Time after which rows are sent to the file at the latest.
const SEND_AFTER: Duration = Duration::from_secs(5);

/// Folds events into a recording.
///
/// The content of the recording depends on the events alone; time determines only how soon it reaches the file. Data
/// that cannot be written, for example because the disk is full, is kept up to 32 MB and written when possible. An
/// error of [`Recorder::push`] or [`Recorder::idle`] ends the recording; later events are not recorded.
pub struct Recorder {
    fold: Fold,
    stream: Option<Stream>,
    health: Arc<SinkHealth>,
    watch: Option<FileWatch>,
    ticks_waiting: u32,
    drawings_waiting: usize,
    sent_at: Instant,
}

impl Recorder {
    /// Creates a recording.
    ///
    /// # Errors
    /// [`RecordingError::Create`] if the file exists or cannot be created.
    pub fn create(path: &Path, identity: &Identity, now: Instant) -> Result<Self, RecordingError> {
        let (sink, watch) = SafeSink::create(path)?;
        Ok(Self { watch: Some(watch), ..Self::open(sink, identity, now)? })
    }

    /// A recording that is written to any writer.
    ///
    /// # Errors
    /// [`RecordingError::Sdk`] if the recording SDK does not start.
    pub fn writing_to(
        out: Box<dyn Write + Send>,
        identity: &Identity,
        now: Instant,
    ) -> Result<Self, RecordingError> {
        Self::open(SafeSink::writing_to(out)?, identity, now)
    }

    fn open(sink: SafeSink, identity: &Identity, now: Instant) -> Result<Self, RecordingError> {
        check_clock(SystemTime::now())?;
        let health = sink.health();
        let stream = Some(Stream::open(sink, identity)?);
        Ok(Self {
            fold: Fold::default(),
            stream,
            health,
            watch: None,
            ticks_waiting: 0,
            drawings_waiting: 0,
            sent_at: now,
        })
    }

    /// State of the file; can still be read after the recorder is dropped.
    pub fn health(&self) -> Arc<SinkHealth> {
        Arc::clone(&self.health)
    }

    /// The reason why the recording is currently not being written; `None` if it is.
    pub fn trouble(&self) -> Option<RecordingError> {
        let why = self.health.error()?;
        Some(if self.health.has_ended() {
            RecordingError::Write { why }
        } else {
            RecordingError::Stalled { why }
        })
    }

    /// Checks that the path still leads to the file that is being written.
    ///
    /// # Errors
    /// The difference.
    pub fn check_file(&self) -> Result<(), FileChange> {
        self.watch.as_ref().map_or(Ok(()), |watch| watch.check(self.health.bytes()))
    }

    /// Adds the next event; does nothing after an error. `account` is the account of the earlier events.
    ///
    /// # Errors
    /// The first error that loses data, once.
    pub fn push(
        &mut self,
        event: &Event,
        account: &account::Fold,
        now: Instant,
    ) -> Result<(), RecordingError> {
        let Some(stream) = &self.stream else { return Ok(()) };
        match self.fold.apply(event, account, stream) {
            Ok(ticks_closed) => self.ticks_waiting += ticks_closed,
            Err(error) => return self.stop(error),
        }
        if let EventKind::Drawn { drawings } = &event.kind {
            self.drawings_waiting += drawings.len();
        }
        let is_much = self.ticks_waiting >= SEND_TICKS || self.drawings_waiting >= SEND_DRAWINGS;
        // When the robot stops, the user wants to see the events that led to it.
        let held = matches!(event.kind, EventKind::Held { .. });
        if held || is_much { self.send(now) } else { self.idle(now) }
    }

    /// Sends waiting rows if they are due; call it regularly while there are no events.
    ///
    /// # Errors
    /// See [`Recorder::push`].
    pub fn idle(&mut self, now: Instant) -> Result<(), RecordingError> {
        if now.saturating_duration_since(self.sent_at) >= SEND_AFTER { self.send(now) } else { Ok(()) }
    }

    /// Writes all data with the given summary and closes the recording. Then merges its chunks into larger ones,
    /// unless that would take longer than the given time. Returns the SHA-256 of the file, hexadecimal, if it is
    /// known.
    ///
    /// # Errors
    /// The first error, even if it has been reported before: the recording is not complete.
    /// [`RecordingError::Changed`] if the file on disk is not the one that was written, or differs in length or
    /// content.
    pub fn finish(
        mut self,
        summary: &Summary,
        until: Option<Instant>,
    ) -> Result<Option<String>, RecordingError> {
        if let Some(stream) = &self.stream {
            self.fold.finish(summary, stream)?;
            self.fold.send(stream)?;
        }
        // Dropping the last handle writes the footer of the format.
        drop(self.stream.take());
        if let Some(why) = self.health.error() {
            return Err(RecordingError::Write { why });
        }
        let Some(watch) = &self.watch else { return Ok(None) };
        let sha256 = self.health.sha256();
        watch.check_content(self.health.bytes(), &sha256)?;
        // Merging is needed even if all rows were sent in one piece: only a merged file has the table of contents of
        // the format.
        if let Err(error) = merge::merge(watch.path(), until) {
            // The recording is complete, but slower to open.
            tracing::warn!("{error}");
            return Ok(Some(sha256));
        }
        Ok(file::sha256(watch.path()).ok())
    }

    fn send(&mut self, now: Instant) -> Result<(), RecordingError> {
        let Some(stream) = &self.stream else { return Ok(()) };
        self.sent_at = now;
        (self.ticks_waiting, self.drawings_waiting) = (0, 0);
        if let Err(error) = self.fold.send(stream) {
            return self.stop(error);
        }
        stream.flush();
        match self.trouble().filter(|_| self.health.has_ended()) {
            Some(error) => self.stop(error),
            None => Ok(()),
        }
    }

    fn stop(&mut self, error: RecordingError) -> Result<(), RecordingError> {
        self.stream = None;
        Err(error)
    }
}

/// Checks that the clock is valid for the recording SDK, which records its start time.
fn check_clock(now: SystemTime) -> Result<(), RecordingError> {
    if now < SystemTime::UNIX_EPOCH { Err(RecordingError::Clock) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_before_1970_is_an_error_and_no_panic() {
        let epoch = SystemTime::UNIX_EPOCH;
        assert!(matches!(check_clock(epoch - Duration::from_secs(1)), Err(RecordingError::Clock)));
        assert!(check_clock(epoch).is_ok() && check_clock(SystemTime::now()).is_ok());
    }
}
