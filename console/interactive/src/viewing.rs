//! Watching a run: its journal is read while another process writes it, or after the run has ended.

use super::{
    inbox::RunOutbox,
    promise::{self, StartPlan},
};
use account::{DoubtWatch, InDoubt};
use anyhow::Context;
use mission::{Event, EventKind, Severity};
use recording::{JournalReader, journal_of};
use runs::{Past, Standing, standing};
use std::{
    path::{Path, PathBuf},
    thread,
    time::{Duration, Instant},
};
use tui::{Msg, RunMsg, RunResult};

/// The interval at which a journal that has not grown is rechecked.
const LOOK_AGAIN: Duration = Duration::from_millis(100);
/// How long events may wait for the rest of their tick.
const PATIENCE: Duration = Duration::from_millis(50);
/// The largest number of events sent together, unless one tick has more.
const MOST: usize = 512;
/// If more messages than this are waiting for the screen, reading pauses.
const MOST_BACKLOG: usize = 64;

/// Reads the journal of a run from its beginning, and follows it while it is being written, on a separate thread.
///
/// # Errors
/// There is no journal, or the thread cannot be started.
pub(super) fn begin(folder: &Path, screen: RunOutbox) -> anyhow::Result<()> {
    let folder = folder.to_owned();
    let writer = folder.clone();
    let reader = JournalReader::follow(&journal_of(&folder), move || {
        thread::sleep(LOOK_AGAIN);
        standing(&writer) == Standing::Running
    })?;
    let viewing = Viewing {
        folder,
        screen,
        read: Vec::new(),
        sent_at: Instant::now(),
        doubt: None,
        start: StartPlan::default(),
    };
    let began = thread::Builder::new().name("journal".into()).spawn(move || viewing.read(reader));
    began.map(drop).context("starting the thread that reads the journal")
}

struct Viewing {
    folder: PathBuf,
    screen: RunOutbox,
    /// Events that were read but not sent yet.
    read: Vec<Event>,
    sent_at: Instant,
    /// Finds the floor in doubt; `None` if no floor can be.
    doubt: Option<DoubtWatch>,
    /// Finds the plan of the start, for its promise.
    start: StartPlan,
}

impl Viewing {
    fn read(mut self, reader: JournalReader) {
        let has_ended = match self.read_all(reader) {
            Ok(has_ended) => has_ended,
            Err(error) => return self.fail(&error.into()),
        };
        if !has_ended {
            self.screen.send(RunMsg::WriterGone);
        }
        match self.result() {
            Ok(result) => drop(self.screen.send(RunMsg::Closed(Box::new(result)))),
            Err(error) => self.fail(&error),
        }
    }

    /// Sends every event; returns whether the last event ends the run.
    fn read_all(&mut self, reader: JournalReader) -> Result<bool, recording::JournalError> {
        let mut has_ended = false;
        for event in reader {
            let event = event?;
            has_ended = matches!(event.kind, EventKind::Ended { .. });
            let is_new_tick = self.read.last().is_some_and(|last| last.tick != event.tick);
            if is_new_tick && (self.read.len() >= MOST || self.sent_at.elapsed() >= PATIENCE) {
                self.send();
            }
            if let Some(found) = self.start.take(&event) {
                promise::send(found, self.screen.clone());
            }
            let in_doubt = self.watch_doubt(&event);
            self.read.push(event);
            if let Some(floor) = in_doubt {
                self.send();
                self.screen.send(RunMsg::InDoubt(floor));
            }
        }
        self.send();
        Ok(has_ended)
    }

    /// The floor in doubt, if the event adds to it.
    fn watch_doubt(&mut self, event: &Event) -> Option<Vec<InDoubt>> {
        if let Some(watch) = &mut self.doubt {
            return watch.apply(event).map(<[InDoubt]>::to_vec);
        }
        self.doubt = DoubtWatch::opening(event);
        None
    }

    fn send(&mut self) {
        while self.screen.backlog() > MOST_BACKLOG {
            thread::sleep(Duration::from_millis(1));
        }
        self.screen.send(RunMsg::Events(std::mem::take(&mut self.read)));
        self.sent_at = Instant::now();
    }

    /// The result of the run according to its journal.
    fn result(&self) -> anyhow::Result<RunResult> {
        let past = Past::read(&self.folder)?;
        let doubt = past.run.logs.error.clone();
        Ok(RunResult {
            summary: Box::new(review::summary(&past)?),
            name: Some(past.run.name.clone()),
            kept: doubt.clone().unwrap_or_else(|| format!("run kept in {}", self.folder.display())),
            is_kept: doubt.is_none(),
        })
    }

    fn fail(&self, error: &anyhow::Error) {
        self.screen.send(RunMsg::OpenFailed(format!("{error:#}")));
        self.say(&format!("{error:#}"));
    }

    fn say(&self, text: &str) {
        self.screen.outbox.send(Msg::Notice { severity: Severity::Crit, text: text.to_owned() });
    }
}
