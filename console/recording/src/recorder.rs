//! Events to a recording for the rerun viewer.

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
/// Rows are sent to the file after this many ticks,
const SEND_TICKS: u32 = 16_384;
/// or after this many drawings of planners, of which a tick may have thousands,
const SEND_DRAWINGS: usize = 1 << 19;
/// or after this time, whichever comes first.
const SEND_AFTER: Duration = Duration::from_secs(5);

/// Folds events into a recording.
///
/// What the recording holds depends on the events alone; time decides only how early it reaches the file. What cannot
/// be written, because the disk is full, is kept up to 32 MB and written when that is possible. An error of
/// [`Recorder::push`] or [`Recorder::idle`] ends the recording; events after it are not recorded.
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
    /// Makes a recording where there is none.
    ///
    /// # Errors
    /// [`RecordingError::Create`] if the file exists or cannot be made.
    pub fn create(path: &Path, identity: &Identity, now: Instant) -> Result<Self, RecordingError> {
        let (sink, watch) = SafeSink::create(path)?;
        Ok(Self { watch: Some(watch), ..Self::open(sink, identity, now)? })
    }

    /// A recording that goes to any writer.
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

    /// How the file is doing; stays readable after the recorder is gone.
    pub fn health(&self) -> Arc<SinkHealth> {
        Arc::clone(&self.health)
    }

    /// Why the recording is not being written now; none if it is.
    pub fn trouble(&self) -> Option<RecordingError> {
        let why = self.health.error()?;
        Some(if self.health.has_ended() {
            RecordingError::Write { why }
        } else {
            RecordingError::Stalled { why }
        })
    }

    /// Whether the path still shows the file that is being written.
    ///
    /// # Errors
    /// How it differs.
    pub fn check_file(&self) -> Result<(), FileChange> {
        self.watch.as_ref().map_or(Ok(()), |watch| watch.check(self.health.bytes()))
    }

    /// Takes in the next event; does nothing after an error. `account` is that of the events before it.
    ///
    /// # Errors
    /// The first error with which data is lost, once.
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
        // Whoever looks at a robot that stands still wants to see how it came to that.
        let held = matches!(event.kind, EventKind::Held { .. });
        if held || is_much { self.send(now) } else { self.idle(now) }
    }

    /// Sends waiting rows if it is time; to be called now and then while nothing happens.
    ///
    /// # Errors
    /// As [`Recorder::push`].
    pub fn idle(&mut self, now: Instant) -> Result<(), RecordingError> {
        if now.saturating_duration_since(self.sent_at) >= SEND_AFTER { self.send(now) } else { Ok(()) }
    }

    /// Writes everything and closes the recording of a run, of which the summary is given. Then its chunks are merged
    /// into larger ones, unless that takes until the moment given. Returns the SHA-256 of the file, hexadecimal, if it is known.
    ///
    /// # Errors
    /// The first error, also if it has been reported before: the recording is not whole.
    /// [`RecordingError::Changed`] if the file on disk is not the one that was written, or has another length or content.
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
        // Also where everything was sent at once: only what is merged has the table of contents of the format.
        if let Err(error) = merge::merge(watch.path(), until) {
            // The recording is whole, only slower to open.
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

/// Makes sure that the recording SDK can say when it began.
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
