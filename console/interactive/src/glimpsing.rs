//! Reads the details of the past run that the operator has selected, for the screen. Reading a long journal takes
//! seconds, so only the run that was selected last is read.

use super::{combining, inbox::Outbox, jobs};
use account::Summary;
use mission::EventKind;
use recording::{JournalReader, journal_of};
use runs::{Standing, standing};
use std::{
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    thread,
};
use tui::{
    Msg,
    model::{Glimpse, Run, Together, glimpse::RunKey},
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
    /// Whether reading the run must stop.
    is_given_up: bool,
}

impl Wanted {
    /// Whether the run that is being read is still the one to read.
    fn goes_on(&self) -> bool {
        self.next.is_none() && !self.is_given_up
    }

    /// Takes the run to read next; without one, the reader ends.
    fn take(&mut self) -> Option<RunKey> {
        let next = self.next.take();
        (self.is_reading, self.is_given_up) = (next.is_some(), false);
        next
    }

    /// Gives up the run that is being read and the one to read next.
    fn give_up(&mut self) {
        (self.next, self.is_given_up) = (None, true);
    }
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

    /// Abandons reading: the processor and the disk are left to the mission.
    pub(super) fn stop(&self) {
        self.wanted().give_up();
    }

    fn work(&self) {
        loop {
            let Some(key) = self.wanted().take() else { return };
            let found = runs::find(key.0.as_ref(), &self.logs).map_err(|error| error.to_string());
            let found = found.and_then(|folder| glimpse(&folder, &self.logs, || self.wanted().goes_on()));
            if let Some(found) = found.transpose() {
                self.outbox.send(Msg::Glimpsed(key, found.map(Box::new)));
            }
        }
    }

    fn wanted(&self) -> MutexGuard<'_, Wanted> {
        self.wanted.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Reads the run in a folder; `None` if it was abandoned.
fn glimpse(folder: &Path, logs: &Path, goes_on: impl Fn() -> bool) -> Result<Option<Glimpse>, String> {
    let mut reader = JournalReader::open(&journal_of(folder)).map_err(|error| error.to_string())?;
    let (mut run, mut scenario_toml) = (Run::default(), String::new());
    for number in 1.. {
        // The part of a journal before the damage can be shown.
        let Ok(Some(line)) = reader.next_line() else { break };
        run.fold(&line.event);
        if let EventKind::RunOpened(opened) = line.event.kind {
            scenario_toml = opened.scenario_toml;
        }
        if number % CHECK_EVENTS == 0 && !goes_on() {
            return Ok(None);
        }
    }
    let name = folder.to_string_lossy();
    let combined = combining::of_rescan(&name, &scenario_toml, logs, &goes_on).transpose();
    if !goes_on() {
        return Ok(None);
    }
    let combined =
        combined.map(|found| found.map(|found| Box::new(Together::new(found, run.coverage.as_ref()))));
    Ok(Some(Glimpse::of(run, summary(folder), combined)))
}

fn summary(folder: &Path) -> Option<Box<Summary>> {
    match standing(folder) {
        Standing::Ended(summary) | Standing::NotRecorded(summary, _) => Some(summary),
        Standing::Running | Standing::JournalOnly { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_is_given_up_for_another_one_or_for_the_mission() {
        let key = |name: &str| Some((name.to_owned(), String::new()));
        let mut wanted = Wanted { next: key("first"), ..Wanted::default() };
        assert!(wanted.take() == key("first") && wanted.goes_on());
        wanted.next = key("second");
        assert!(!wanted.goes_on() && wanted.take() == key("second") && wanted.goes_on());
        wanted.next = key("third");
        wanted.give_up();
        assert!(!wanted.goes_on(), "neither the second nor the third");
        assert!(wanted.take().is_none() && !wanted.is_reading);
        wanted.next = key("fourth");
        assert!(wanted.take() == key("fourth") && wanted.goes_on());
    }
}
