//! The writing thread: writes both files, and checks them.

use super::shared::Shared;
use crate::{
    error::RecordingError,
    file::FileChange,
    journal::{JournalEnd, JournalError, JournalWriter},
    marker::FailureMarker,
    readings::ReadingsWriter,
    recorder::Recorder,
};
use account::{Fold, Summary};
use mission::{Event, EventKind};
use std::{
    path::PathBuf,
    sync::{
        Arc,
        atomic::Ordering,
        mpsc::{Receiver, RecvTimeoutError, Sender},
    },
    time::{Duration, Instant},
};

/// Longest sleep of the thread, so that waiting data is written even if there are no events.
const IDLE: Duration = Duration::from_millis(100);
/// Time for which the thread collects batches after the first one, so that a sender with thousands of ticks per
/// second does not wake it for each of them.
const GATHER: Duration = Duration::from_millis(2);
/// Interval between comparisons of the files on disk with those that are being written. Together with [`IDLE`] and
/// the 400 ms refresh of a screen, an operator sees a problem within a second.
const WATCH_PERIOD: Duration = Duration::from_millis(300);

/// A message to the thread.
pub(super) enum Batch {
    /// The events of a tick.
    Events(Arc<[Event]>),
    /// Hand everything to the system that came before, then answer.
    Flush(Sender<()>),
}

/// The result of the thread.
pub(super) struct Ended {
    /// The final data of the journal, if it is complete.
    pub(super) journal: Option<JournalEnd>,
    /// Summary of the run.
    pub(super) summary: Summary,
    /// SHA-256 of the recording, hexadecimal, if it is complete.
    pub(super) recording_sha256: Option<String>,
}

/// The data of the thread.
pub(super) struct Writer {
    account: Fold,
    journal: Option<JournalWriter>,
    recorder: Option<Recorder>,
    /// The path of the readings until they are begun.
    readings_path: Option<PathBuf>,
    readings: Option<ReadingsWriter>,
    marker: Option<FailureMarker>,
    shared: Arc<Shared>,
    watched: Instant,
    changed: Option<String>,
}

impl Writer {
    /// A writer of files that were started.
    pub(super) fn new(
        journal: JournalWriter,
        recorder: Option<Recorder>,
        readings_path: Option<PathBuf>,
        marker: Option<FailureMarker>,
        shared: Arc<Shared>,
    ) -> Self {
        let (account, journal) = (Fold::new(), Some(journal));
        let (watched, changed, readings) = (Instant::now(), None, None);
        Self { account, journal, recorder, readings_path, readings, marker, shared, watched, changed }
    }

    /// Writes until all senders are dropped.
    pub(super) fn run(mut self, batches: &Receiver<Batch>) -> Ended {
        loop {
            match batches.recv_timeout(IDLE) {
                Ok(batch) => self.take(batch),
                Err(RecvTimeoutError::Timeout) => self.idle(),
                Err(RecvTimeoutError::Disconnected) => return self.close(),
            }
            for batch in batches.try_iter() {
                self.take(batch);
            }
            std::thread::sleep(GATHER);
        }
    }

    fn take(&mut self, batch: Batch) {
        match batch {
            Batch::Events(events) => self.write(&events),
            Batch::Flush(done) => {
                let now = Instant::now();
                // Errors of the journal are read below.
                let _ = self.journal.as_mut().map(|journal| journal.flush(now));
                self.look(now);
                // The caller may have stopped waiting.
                let _ = done.send(());
            }
        }
    }

    fn write(&mut self, events: &[Event]) {
        let now = Instant::now();
        for event in events {
            // Errors of the journal are read below.
            let _ = self.journal.as_mut().map(|journal| journal.append(event, now));
            let account = &self.account;
            if let Some(Err(error)) =
                self.recorder.as_mut().map(|recorder| recorder.push(event, account, now))
            {
                self.shared.lose(&error);
            }
            self.account.apply(event);
            if let Err(error) = self.read(event) {
                self.readings = None;
                self.shared.lose(&error);
            }
        }
        self.shared.done.fetch_add(1, Ordering::Relaxed);
        self.look(now);
    }

    /// Writes the readings that belong to an event; the file is begun with the run if the instrument reads thickness.
    fn read(&mut self, event: &Event) -> Result<(), RecordingError> {
        let Some(survey) = self.account.survey() else { return Ok(()) };
        match (&event.kind, &mut self.readings) {
            (EventKind::RunOpened(_), _) => {
                let path = self.readings_path.take();
                self.readings = path.map(|path| ReadingsWriter::create(&path)).transpose()?;
                Ok(())
            }
            (EventKind::Estimated { .. }, Some(readings)) => readings.write(survey.latest()),
            _ => Ok(()),
        }
    }

    fn idle(&mut self) {
        let now = Instant::now();
        let _ = self.journal.as_mut().map(|journal| journal.tick(now));
        if let Some(Err(error)) = self.recorder.as_mut().map(|recorder| recorder.idle(now)) {
            self.shared.lose(&error);
        }
        self.look(now);
    }

    /// Checks both files, and shares the result.
    fn look(&mut self, now: Instant) {
        if now.saturating_duration_since(self.watched) >= WATCH_PERIOD {
            self.watched = now;
            self.changed = self.check_files().err();
        }
        let bytes = self.journal.as_ref().map_or(0, JournalWriter::written_bytes);
        self.shared.journal_bytes.store(bytes, Ordering::Relaxed);
        self.shared.set_trouble(self.trouble());
        self.mark();
    }

    fn check_files(&self) -> Result<(), String> {
        let as_text = |error: RecordingError| error.to_string();
        let journal = self.journal.as_ref().map_or(Ok(()), JournalWriter::check_file);
        journal.map_err(|change| as_text(JournalError::from(change).into()))?;
        let recording = self.recorder.as_ref().map_or(Ok(()), Recorder::check_file);
        recording.map_err(|change: FileChange| as_text(change.into()))
    }

    fn trouble(&self) -> Option<String> {
        let journal = self.journal.as_ref().and_then(JournalWriter::trouble).map(|error| error.to_string());
        let recording = || self.recorder.as_ref().and_then(Recorder::trouble).map(|error| error.to_string());
        journal.or_else(recording).or_else(|| self.changed.clone())
    }

    /// Reports the current problem in the folder of the run, or removes the report.
    fn mark(&mut self) {
        if let Some(marker) = &mut self.marker {
            marker.show(self.shared.error().as_deref());
        }
    }

    fn close(&mut self) -> Ended {
        let journal = self.journal.take().map(JournalWriter::finish).transpose();
        let mut summary = self.account.summary();
        match self.readings.take().map(ReadingsWriter::finish).transpose() {
            Ok(sha256) => summary.readings_sha256 = sha256,
            Err(error) => self.shared.lose(&error),
        }
        let until = self.shared.merge_until();
        let recording = self.recorder.take().map_or(Ok(None), |recorder| recorder.finish(&summary, until));
        let journal = journal.unwrap_or_else(|error| {
            self.shared.lose(&error);
            None
        });
        let recording_sha256 = recording.unwrap_or_else(|error| {
            self.shared.lose(&error);
            None
        });
        if let Some(end) = &journal {
            self.shared.journal_bytes.store(end.bytes, Ordering::Relaxed);
        }
        // The outcome for each file is now known; problems that have passed no longer matter.
        self.shared.set_trouble(None);
        self.mark();
        Ended { journal, summary, recording_sha256 }
    }
}
