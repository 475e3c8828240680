//! The thread that writes the journal and the recording while the mission continues.

mod shared;
mod sync;
mod writer;

use crate::{
    error::RecordingError,
    identity::Identity,
    journal::{JOURNAL_FILE, JournalWriter},
    marker::FailureMarker,
    readings::READINGS_FILE,
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
        mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender, sync_channel},
    },
    thread,
    time::{Duration, Instant},
};
use writer::{Batch, Ended, Writer};

/// Maximum number of batches of events in the queue; if it is full, the sender waits.
const QUEUE: usize = 8192;
/// Maximum time to wait for a recorder that is dropped before it has finished.
const DROP_TIMEOUT: Duration = Duration::from_secs(2);
/// The files to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Whether to write the recording for the viewer.
    pub rrd: bool,
    /// Whether to write the journal. Its hash is computed in any case.
    pub journal: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { rrd: true, journal: true }
    }
}

/// State of the recorder.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Health {
    /// Number of bytes of the journal handed to the system.
    pub journal_bytes: u64,
    /// Number of bytes of the recording handed to the system.
    pub rrd_bytes: u64,
    /// Number of batches of events waiting to be written.
    pub lag: u64,
    /// The problem with the journal or recording on disk, as a sentence. It is cleared once all data has been
    /// written, or when a file that was moved has been put back.
    pub error: Option<String>,
}

/// The result of a recorder.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Finished {
    /// Summary of the run from its events; absent if the recorder did not finish in time.
    pub summary: Option<Box<Summary>>,
    /// SHA-256 of the data written to the journal, hexadecimal; absent if the journal is not complete, or if the file
    /// at its path is not the file that was written or has a different length. The file is not read again: `verify`
    /// does that.
    pub events_sha256: Option<String>,
    /// Path of the journal, if one was started.
    pub journal: Option<PathBuf>,
    /// Path of the recording, if one was started.
    pub recording: Option<PathBuf>,
    /// SHA-256 of the recording, hexadecimal; absent if it is not complete.
    pub recording_sha256: Option<String>,
    /// The reason why journal or recording is incomplete or missing, as a sentence. If there is no reason, each file at
    /// its path is the file that was opened, and contains every byte that was written.
    pub error: Option<String>,
}

/// Writes the journal and the recording of a run in a separate thread.
///
/// [`RunRecorder::send`] queues events and returns immediately, unless 8192 batches are waiting. In that case, the
/// simulation waits for the disk, and no data is lost. An error affects only its own file and appears in
/// [`RunRecorder::health`] within a second. The same applies to a file that another program deletes, replaces or
/// truncates. The other file and the mission continue. [`crate::FAILURE_FILE`] in the folder of the run states the
/// reason for later readers.
pub struct RunRecorder {
    sender: Option<SyncSender<Batch>>,
    /// A lock protects the value so that screens can read the health from other threads; only `close` takes the value
    /// out.
    ended: Mutex<Receiver<Ended>>,
    shared: Arc<Shared>,
    sink: Option<Arc<SinkHealth>>,
    journal: Option<PathBuf>,
    recording: Option<PathBuf>,
    /// The journal's file, until a thread is started that syncs it to disk.
    unsynced: Option<File>,
}

impl RunRecorder {
    /// Starts the journal and the recording in the folder of a run, which must exist; the folder name is the name of the
    /// run.
    ///
    /// # Errors
    /// A file exists or cannot be created.
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
        let readings = options.journal.then(|| folder.join(READINGS_FILE));
        let mut started = Self::spawn_with(writer, recorder, readings, marker)?;
        (started.journal, started.recording, started.unsynced) = (journal, recording, unsynced);
        Ok(started)
    }

    /// A recorder with a journal and a recording that were started elsewhere.
    ///
    /// # Errors
    /// [`RecordingError::Thread`] if the system cannot start a thread.
    pub fn spawn(journal: JournalWriter, recorder: Option<Recorder>) -> Result<Self, RecordingError> {
        Self::spawn_with(journal, recorder, None, None)
    }

    fn spawn_with(
        journal: JournalWriter,
        recorder: Option<Recorder>,
        readings: Option<PathBuf>,
        marker: Option<FailureMarker>,
    ) -> Result<Self, RecordingError> {
        let shared = Arc::new(Shared::default());
        let sink = recorder.as_ref().map(Recorder::health);
        let (sender, batches) = sync_channel(QUEUE);
        let (end_sender, ended) = sync_channel(1);
        let writer = Writer::new(journal, recorder, readings, marker, Arc::clone(&shared));
        let thread = thread::Builder::new().name("recorder".into());
        let handle = thread.spawn(move || {
            let end = writer.run(&batches);
            // The receiver may be gone already.
            let _ = end_sender.send(end);
        });
        handle.map_err(|error| RecordingError::Thread { why: error.to_string() })?;
        let ended = Mutex::new(ended);
        Ok(Self { sender: Some(sender), ended, shared, sink, journal: None, recording: None, unsynced: None })
    }

    /// Syncs the journal to disk every second from now on. A loss of power then costs no more than that second, plus
    /// the data not yet handed to the system. Only a separate thread waits for the disk.
    ///
    /// # Errors
    /// [`RecordingError::Thread`] if the system cannot start a thread.
    pub fn sync(&mut self) -> Result<(), RecordingError> {
        let Some(file) = self.unsynced.take() else { return Ok(()) };
        let error = |error: std::io::Error| RecordingError::Thread { why: error.to_string() };
        sync::begin(file, &self.shared).map_err(error)
    }

    /// Queues the events of a tick for writing; waits while the queue is full.
    pub fn send(&self, events: impl Into<Arc<[Event]>>) {
        let Some(sender) = &self.sender else { return };
        self.shared.sent.fetch_add(1, Ordering::Relaxed);
        if sender.send(Batch::Events(events.into())).is_err() {
            self.shared.lose(&"the recorder's thread has ended");
        }
    }

    /// Hands the journal to the system, including all events that were sent before, and then answers; waits only while the
    /// queue is full. A stop of the whole process after the answer loses none of these events.
    pub fn flush(&self, done: Sender<()>) {
        if let Some(sender) = &self.sender {
            // A thread that has ended has reported why; the caller's end of the channel is then closed.
            let _ = sender.send(Batch::Flush(done));
        }
    }

    /// State of the recorder; never waits.
    pub fn health(&self) -> Health {
        Health {
            journal_bytes: self.shared.journal_bytes.load(Ordering::Relaxed),
            rrd_bytes: self.sink.as_ref().map_or(0, |sink| sink.bytes()),
            lag: self.lag(),
            error: self.shared.error(),
        }
    }

    /// Whether half of the queue is full, so that a sender that must not wait should pause.
    pub fn is_behind(&self) -> bool {
        self.lag() > (QUEUE / 2) as u64
    }

    /// Number of batches of events waiting to be written.
    fn lag(&self) -> u64 {
        let sent = self.shared.sent.load(Ordering::Relaxed);
        sent.saturating_sub(self.shared.done.load(Ordering::Relaxed))
    }

    /// Writes all waiting data, closes both files, and returns the result.
    ///
    /// If `timeout` passes, the thread keeps the files, and the error says so.
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
        // The other half is for data that is still waiting to be written, and for slow disks.
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
                self.shared.lose(
                    &"the recorder's thread stopped unexpectedly; the end of the journal and of the recording \
                        is missing",
                );
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
