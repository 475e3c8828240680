//! The thread that writes journal and recording while the mission goes on.

use crate::{
    JOURNAL_FILE, RECORDING_FILE,
    error::RecordingError,
    identity::Identity,
    journal::{JournalEnd, JournalWriter},
    recorder::Recorder,
    sink::SinkHealth,
};
use mission::Event;
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex, OnceLock, PoisonError,
        atomic::{AtomicU64, Ordering},
        mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel},
    },
    thread,
    time::{Duration, Instant},
};

/// Batches of events that may wait; when so many do, the sender waits.
const QUEUE: usize = 8192;
/// How long the thread sleeps at most, so that what waits to be written is written when nothing happens.
const IDLE: Duration = Duration::from_millis(100);
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
    /// The first error, as a sentence.
    pub error: Option<String>,
}

/// What a recorder leaves behind.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Finished {
    /// SHA-256 of the journal, hexadecimal; absent if the journal is not whole.
    pub events_sha256: Option<String>,
    /// The journal, if one was begun.
    pub journal: Option<PathBuf>,
    /// The recording, if one was begun.
    pub recording: Option<PathBuf>,
    /// The first error, as a sentence; both files hold everything before it.
    pub error: Option<String>,
}

/// Figures that the thread and everyone else share.
#[derive(Default)]
struct Shared {
    sent: AtomicU64,
    done: AtomicU64,
    journal_bytes: AtomicU64,
    error: OnceLock<String>,
}

impl Shared {
    fn fail(&self, error: &impl ToString) {
        // Only the first error tells what happened.
        let _ = self.error.set(error.to_string());
    }
}

/// Writes journal and recording of a run in a thread of its own.
///
/// [`RunRecorder::send`] hands over events and returns at once, unless 8192 batches wait: then the simulation waits
/// for the disk, and nothing is lost. An error stops the file that it hits and shows in [`RunRecorder::health`];
/// everything else goes on.
pub struct RunRecorder {
    sender: Option<SyncSender<Arc<[Event]>>>,
    /// Behind a lock so that screens may ask for the health from other threads; only `close` takes it.
    ended: Mutex<Receiver<Option<JournalEnd>>>,
    shared: Arc<Shared>,
    sink: Option<Arc<SinkHealth>>,
    journal: Option<PathBuf>,
    recording: Option<PathBuf>,
}

/// What the thread owns.
struct Writer {
    journal: Option<JournalWriter>,
    recorder: Option<Recorder>,
    shared: Arc<Shared>,
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
        let identity = Identity::of_folder(folder);
        let recorder = recording.as_ref().map(|path| Recorder::create(path, &identity, now)).transpose()?;
        let mut started = Self::spawn(writer, recorder)?;
        (started.journal, started.recording) = (journal, recording);
        Ok(started)
    }

    /// A recorder over a journal and a recording that were begun elsewhere.
    ///
    /// # Errors
    /// [`RecordingError::Thread`] if the system gives no thread.
    pub fn spawn(journal: JournalWriter, recorder: Option<Recorder>) -> Result<Self, RecordingError> {
        let shared = Arc::new(Shared::default());
        let sink = recorder.as_ref().map(Recorder::health);
        let (sender, batches) = sync_channel(QUEUE);
        let (tell_end, ended) = sync_channel(1);
        let writer = Writer { journal: Some(journal), recorder, shared: Arc::clone(&shared) };
        let thread = thread::Builder::new().name("recorder".into());
        let handle = thread.spawn(move || {
            let end = writer.run(&batches);
            // Nobody may be waiting any more.
            let _ = tell_end.send(end);
        });
        handle.map_err(|error| RecordingError::Thread { why: error.to_string() })?;
        let ended = Mutex::new(ended);
        Ok(Self { sender: Some(sender), ended, shared, sink, journal: None, recording: None })
    }

    /// Hands over the events of a tick; waits while the queue is full.
    pub fn send(&self, events: impl Into<Arc<[Event]>>) {
        let Some(sender) = &self.sender else { return };
        self.shared.sent.fetch_add(1, Ordering::Relaxed);
        if sender.send(events.into()).is_err() {
            self.shared.fail(&"the recorder's thread has ended");
        }
    }

    /// How the recorder is doing; never waits.
    pub fn health(&self) -> Health {
        let sent = self.shared.sent.load(Ordering::Relaxed);
        Health {
            journal_bytes: self.shared.journal_bytes.load(Ordering::Relaxed),
            rrd_bytes: self.sink.as_ref().map_or(0, |sink| sink.bytes()),
            lag: sent.saturating_sub(self.shared.done.load(Ordering::Relaxed)),
            error: self.error(),
        }
    }

    /// Writes everything that waits, closes both files, and tells what is there.
    ///
    /// After `timeout` the files are left to the thread, and the error says so.
    pub fn finish(mut self, timeout: Duration) -> Finished {
        let end = self.close(timeout);
        Finished {
            events_sha256: end.map(|end| end.events_sha256),
            journal: self.journal.take(),
            recording: self.recording.take(),
            error: self.error(),
        }
    }

    fn close(&mut self, timeout: Duration) -> Option<JournalEnd> {
        drop(self.sender.take()?);
        let ended = self.ended.get_mut().unwrap_or_else(PoisonError::into_inner);
        match ended.recv_timeout(timeout) {
            Ok(end) => end,
            Err(RecvTimeoutError::Timeout) => {
                let waited = timeout.as_secs_f64();
                self.shared
                    .fail(&format!("the recording was not closed within {waited} s; its end may be missing"));
                None
            }
            Err(RecvTimeoutError::Disconnected) => {
                self.shared
                    .fail(&"the recorder's thread broke off; the ends of journal and recording are missing");
                None
            }
        }
    }

    fn error(&self) -> Option<String> {
        let told = self.shared.error.get().cloned();
        told.or_else(|| {
            let why = self.sink.as_ref()?.error()?.to_owned();
            Some(RecordingError::Write { why }.to_string())
        })
    }
}

impl Drop for RunRecorder {
    fn drop(&mut self) {
        self.close(DROP_TIMEOUT);
    }
}

impl Writer {
    /// Writes until nobody sends any more.
    fn run(mut self, batches: &Receiver<Arc<[Event]>>) -> Option<JournalEnd> {
        loop {
            match batches.recv_timeout(IDLE) {
                Ok(events) => self.write(&events),
                Err(RecvTimeoutError::Timeout) => self.idle(),
                Err(RecvTimeoutError::Disconnected) => return self.close(),
            }
        }
    }

    fn write(&mut self, events: &[Event]) {
        let now = Instant::now();
        for event in events {
            if let Some(journal) = &mut self.journal
                && let Err(error) = journal.append(event, now)
            {
                self.shared.fail(&error);
            }
            if let Some(recorder) = &mut self.recorder
                && let Err(error) = recorder.push(event, now)
            {
                self.shared.fail(&error);
            }
        }
        self.shared.done.fetch_add(1, Ordering::Relaxed);
        self.count();
    }

    fn idle(&mut self) {
        let now = Instant::now();
        if let Some(journal) = &mut self.journal
            && let Err(error) = journal.tick(now)
        {
            self.shared.fail(&error);
        }
        if let Some(recorder) = &mut self.recorder
            && let Err(error) = recorder.idle(now)
        {
            self.shared.fail(&error);
        }
        self.count();
    }

    fn count(&self) {
        let bytes = self.journal.as_ref().map_or(0, JournalWriter::written_bytes);
        self.shared.journal_bytes.store(bytes, Ordering::Relaxed);
    }

    fn close(&mut self) -> Option<JournalEnd> {
        let end = self.journal.take().map(JournalWriter::finish);
        if let Some(Err(error)) = &end {
            self.shared.fail(error);
        }
        let end = end.and_then(Result::ok);
        if let Some(end) = &end {
            self.shared.journal_bytes.store(end.bytes, Ordering::Relaxed);
        }
        if let Some(Err(error)) = self.recorder.take().map(Recorder::finish) {
            self.shared.fail(&error);
        }
        end
    }
}
