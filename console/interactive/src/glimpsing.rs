//! Reads what the screen shows about a past run that the operator has selected. Reading a long journal takes seconds, so
//! only the run that was selected last is read.

use super::{inbox::Outbox, jobs};
use account::Summary;
use recording::{JournalReader, journal_of};
use runs::{Standing, standing};
use std::{
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    thread,
};
use tui::{
    Msg,
    model::{Glimpse, Log, Run, glimpse::RunKey},
};

/// The number of events after which the reader checks whether another run is wanted.
const CHECK_EVENTS: usize = 4096;

/// The reader of past runs.
#[derive(Clone)]
pub(super) struct Glimpsing {
    logs: PathBuf,
    outbox: Outbox,
    wanted: Arc<Mutex<Wanted>>,
}

#[derive(Default)]
struct Wanted {
    next: Option<RunKey>,
    is_reading: bool,
}

impl Glimpsing {
    /// Creates a reader of the runs in a folder.
    pub(super) fn new(logs: PathBuf, outbox: Outbox) -> Self {
        Self { logs, outbox, wanted: Arc::default() }
    }

    /// Reads a run on a separate thread; a run that is being read is abandoned.
    pub(super) fn ask(&self, key: RunKey) {
        let mut wanted = self.wanted();
        wanted.next = Some(key);
        if std::mem::replace(&mut wanted.is_reading, true) {
            return;
        }
        let reader = self.clone();
        if let Err(error) = thread::Builder::new().name("glimpse".into()).spawn(move || reader.work()) {
            wanted.is_reading = false;
            jobs::report(&self.outbox, &format!("the selected run cannot be read: {error}"));
        }
    }

    fn work(&self) {
        while let Some(key) = self.next() {
            let found = runs::find(key.0.as_ref(), &self.logs).map_err(|error| error.to_string());
            let found = found.and_then(|folder| glimpse(&folder, || self.wanted().next.is_none()));
            if let Some(found) = found.transpose() {
                self.outbox.send(Msg::Glimpsed(key, found.map(Box::new)));
            }
        }
    }

    fn next(&self) -> Option<RunKey> {
        let mut wanted = self.wanted();
        let next = wanted.next.take();
        wanted.is_reading = next.is_some();
        next
    }

    fn wanted(&self) -> MutexGuard<'_, Wanted> {
        self.wanted.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Reads the run in a folder; `None` if it was abandoned.
fn glimpse(folder: &Path, goes_on: impl Fn() -> bool) -> Result<Option<Glimpse>, String> {
    let mut reader = JournalReader::open(&journal_of(folder)).map_err(|error| error.to_string())?;
    let mut run = Run::default();
    for number in 1.. {
        // What precedes damage in a journal can be shown.
        let Ok(Some(line)) = reader.next_line() else { break };
        run.fold(&line.event);
        if number % CHECK_EVENTS == 0 && !goes_on() {
            return Ok(None);
        }
    }
    run.log = Log::default();
    Ok(Some(Glimpse { run, summary: summary(folder) }))
}

fn summary(folder: &Path) -> Option<Box<Summary>> {
    match standing(folder) {
        Standing::Ended(summary) | Standing::NotRecorded(summary, _) => Some(summary),
        Standing::Running | Standing::JournalOnly { .. } => None,
    }
}
