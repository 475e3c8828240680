//! The thread that writes journal and recording while the mission goes on.

mod shared;
mod sync;
mod writer;

use crate::{
    error::RecordingError,
    identity::Identity,
    journal::{JOURNAL_FILE, JournalWriter},
    marker::FailureMarker,
    recorder::{RECORDING_FILE, Recorder},
    sink::SinkHealth,
};
use account::Summary;
use mission::Event;
use shared::Shared;
use std::{
    fs::File,
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex, PoisonError,
        atomic::Ordering,
        mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel},
    },
    thread,
    time::{Duration, Instant},
};
use writer::{Ended, Writer};

/// Batches of events that may wait; when so many do, the sender waits.
const QUEUE: usize = 8192;
/// How long a recorder that is dropped without being finished is waited for.
const DROP_TIMEOUT: Duration = Duration::from_secs(2);
/// What to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Write the recording for the viewer.
    pub rrd: bool,
    /// Write the journal. Its hash is computed in any case.
    pub journal: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { rrd: true, journal: true }
    }
}

/// How the recorder is doing.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Health {
    /// Bytes of the journal that the system has got.
    pub journal_bytes: u64,
    /// Bytes of the recording that the system has got.
    pub rrd_bytes: u64,
    /// Batches of events that wait to be written.
    pub lag: u64,
    /// Why journal or recording is not on disk as it should be, as a sentence. It goes away if everything could be
    /// written in the end, or if a file that was moved is back in its place.
    pub error: Option<String>,
}

/// What a recorder leaves behind.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Finished {
    /// What the run came to, from its events; absent if the recorder was not done in time.
    pub summary: Option<Box<Summary>>,
    /// SHA-256 of what was written to the journal, hexadecimal; absent if the journal is not whole, or its path does
    /// not show the file that was written, at its length. The file is not read again: `verify` does that.
    pub events_sha256: Option<String>,
    /// The journal, if one was begun.
    pub journal: Option<PathBuf>,
    /// The recording, if one was begun.
    pub recording: Option<PathBuf>,
    /// SHA-256 of the recording, hexadecimal; absent if it is not whole.
    pub recording_sha256: Option<String>,
    /// Why journal or recording is not whole or not there, as a sentence. Absent, each is the file that was opened,
    /// in its place, with every byte that was written to it.
    pub error: Option<String>,
}

/// Writes journal and recording of a run in a thread of its own.
///
/// [`RunRecorder::send`] hands over events and returns at once, unless 8192 batches wait: then the simulation waits
/// for the disk, and nothing is lost. An error concerns only the file that it hits and shows in
/// [`RunRecorder::health`] within a second, as does a file that others delete, replace or truncate; everything else
/// goes on. In the folder of the run [`crate::FAILURE_FILE`] says why, for those who look at it later.
pub struct RunRecorder {
    sender: Option<SyncSender<Arc<[Event]>>>,
    /// Behind a lock so that screens may ask for the health from other threads; only `close` takes it.
    ended: Mutex<Receiver<Ended>>,
    shared: Arc<Shared>,
    sink: Option<Arc<SinkHealth>>,
    journal: Option<PathBuf>,
    recording: Option<PathBuf>,
    /// The journal's file, until somebody puts it on disk regularly.
    unsynced: Option<File>,
}

impl RunRecorder {
    /// Begins journal and recording in the folder of a run, which must exist; its name is the name of the run.
    ///
    /// # Errors
    /// A file exists or cannot be made.
    pub fn start(folder: &Path, options: Options) -> Result<Self, RecordingError> {
        let now = Instant::now();
        let journal = options.journal.then(|| folder.join(JOURNAL_FILE));
        let recording = options.rrd.then(|| folder.join(RECORDING_FILE));
        let writer = match &journal {
            Some(path) => JournalWriter::create(path, now)?,
            None => JournalWriter::unwritten(now),
        };
        let unsynced = writer.file().and_then(|file| file.try_clone().ok());
        let identity = Identity::of_folder(folder);
        let recorder = recording.as_ref().map(|path| Recorder::create(path, &identity, now)).transpose()?;
        let marker = (options.journal || options.rrd).then(|| FailureMarker::reserve(folder)).transpose();
        let marker = marker
            .map_err(|error| RecordingError::Marker { why: error.to_string(), folder: folder.to_owned() })?;
        let mut started = Self::spawn_with(writer, recorder, marker)?;
        (started.journal, started.recording, started.unsynced) = (journal, recording, unsynced);
        Ok(started)
    }

    /// A recorder over a journal and a recording that were begun elsewhere.
    ///
    /// # Errors
    /// [`RecordingError::Thread`] if the system gives no thread.
    pub fn spawn(journal: JournalWriter, recorder: Option<Recorder>) -> Result<Self, RecordingError> {
        Self::spawn_with(journal, recorder, None)
    }

    fn spawn_with(
        journal: JournalWriter,
        recorder: Option<Recorder>,
        marker: Option<FailureMarker>,
    ) -> Result<Self, RecordingError> {
        let shared = Arc::new(Shared::default());
        let sink = recorder.as_ref().map(Recorder::health);
        let (sender, batches) = sync_channel(QUEUE);
        let (end_sender, ended) = sync_channel(1);
        let writer = Writer::new(journal, recorder, marker, Arc::clone(&shared));
        let thread = thread::Builder::new().name("recorder".into());
        let handle = thread.spawn(move || {
            let end = writer.run(&batches);
            // Nobody may be waiting any more.
            let _ = end_sender.send(end);
        });
        handle.map_err(|error| RecordingError::Thread { why: error.to_string() })?;
        let ended = Mutex::new(ended);
        Ok(Self { sender: Some(sender), ended, shared, sink, journal: None, recording: None, unsynced: None })
    }

    /// From now on has the system put the journal on disk every second, so that a loss of power costs no more than that and what
    /// the journal had not given to the system yet. A thread of its own waits for the disk, nobody else.
    ///
    /// # Errors
    /// [`RecordingError::Thread`] if the system gives no thread.
    pub fn sync(&mut self) -> Result<(), RecordingError> {
        let Some(file) = self.unsynced.take() else { return Ok(()) };
        let error = |error: std::io::Error| RecordingError::Thread { why: error.to_string() };
        sync::begin(file, &self.shared).map_err(error)
    }

    /// Hands over the events of a tick; waits while the queue is full.
    pub fn send(&self, events: impl Into<Arc<[Event]>>) {
        let Some(sender) = &self.sender else { return };
        self.shared.sent.fetch_add(1, Ordering::Relaxed);
        if sender.send(events.into()).is_err() {
            self.shared.lose(&"the recorder's thread has ended");
        }
    }

    /// How the recorder is doing; never waits.
    pub fn health(&self) -> Health {
        Health {
            journal_bytes: self.shared.journal_bytes.load(Ordering::Relaxed),
            rrd_bytes: self.sink.as_ref().map_or(0, |sink| sink.bytes()),
            lag: self.lag(),
            error: self.shared.error(),
        }
    }

    /// Whether half of the queue is full, so that a sender that must not wait should send no more for now.
    pub fn is_behind(&self) -> bool {
        self.lag() > (QUEUE / 2) as u64
    }

    /// Batches of events that wait to be written.
    fn lag(&self) -> u64 {
        let sent = self.shared.sent.load(Ordering::Relaxed);
        sent.saturating_sub(self.shared.done.load(Ordering::Relaxed))
    }

    /// Writes everything that waits, closes both files, and reports what is there.
    ///
    /// After `timeout` the files are left to the thread, and the error says so.
    pub fn finish(mut self, timeout: Duration) -> Finished {
        let ended = self.close(timeout);
        let journal_end = ended.as_ref().and_then(|ended| ended.journal.clone());
        let recording_sha256 = ended.as_ref().and_then(|ended| ended.recording_sha256.clone());
        Finished {
            summary: ended.map(|ended| Box::new(ended.summary)),
            events_sha256: journal_end.map(|end| end.events_sha256),
            journal: self.journal.take(),
            recording: self.recording.take(),
            recording_sha256,
            error: self.shared.error(),
        }
    }

    fn close(&mut self, timeout: Duration) -> Option<Ended> {
        let sender = self.sender.take()?;
        // The other half is for what still waits to be written, and for slow disks.
        self.shared.set_merge_until(Instant::now() + timeout / 2);
        drop(sender);
        let ended = self.ended.get_mut().unwrap_or_else(PoisonError::into_inner);
        match ended.recv_timeout(timeout) {
            Ok(ended) => Some(ended),
            Err(RecvTimeoutError::Timeout) => {
                let waited = timeout.as_secs_f64();
                self.shared
                    .lose(&format!("the recording was not closed within {waited} s; its end may be missing"));
                None
            }
            Err(RecvTimeoutError::Disconnected) => {
                self.shared
                    .lose(&"the recorder's thread broke off; the ends of journal and recording are missing");
                None
            }
        }
    }
}

impl Drop for RunRecorder {
    fn drop(&mut self) {
        self.close(DROP_TIMEOUT);
    }
}
