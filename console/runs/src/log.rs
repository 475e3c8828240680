//! What is written about a run while it is flown: journal, recording and, at its end, the report.

use crate::{
    headless,
    run_folder::{Kept, RunFolder},
};
use mission::Event;
use planner_host::Host;
use recording::{Health, JournalWriter, Options, RunRecorder};
use report::{Fold, Logs, Stops, Summary};
use scenario::Scenario;
use std::{
    path::Path,
    time::{Duration, Instant},
};

/// A run that is being written, or, without a folder, only computed.
pub(crate) struct RunLog {
    folder: Option<RunFolder>,
    recorder: RunRecorder,
    fold: Fold,
    began: Instant,
}

/// A run that was flown.
pub(crate) struct Closed {
    /// Its report.
    pub summary: Summary,
    /// Whether it is on disk; `None` if it was not to be.
    pub kept: Option<Kept>,
}

impl RunLog {
    /// Makes the folder of the run and begins its files.
    ///
    /// # Errors
    /// They cannot be made.
    pub(crate) fn create(logs: &Path, scenario: &Scenario, planner: &str) -> anyhow::Result<Self> {
        let folder = RunFolder::create(logs, &scenario.name, planner, scenario.seed)?;
        let recorder = RunRecorder::start(folder.path(), Options::default())?;
        Ok(Self { folder: Some(folder), recorder, fold: Fold::new(), began: Instant::now() })
    }

    /// Writes nothing, but computes report and hash.
    ///
    /// # Errors
    /// The system gives no thread.
    pub(crate) fn unwritten() -> anyhow::Result<Self> {
        let began = Instant::now();
        let recorder = RunRecorder::spawn(JournalWriter::unwritten(began), None)?;
        Ok(Self { folder: None, recorder, fold: Fold::new(), began })
    }

    /// Takes the events of a tick; waits while the recorder's queue is full.
    pub(crate) fn keep(&mut self, events: &[Event]) {
        for event in events {
            self.fold.apply(event);
        }
        self.recorder.send(events);
    }

    /// How recording goes.
    pub(crate) fn health(&self) -> Health {
        self.recorder.health()
    }

    /// Whether so much waits to be written that the caller should wait before it sends more.
    pub(crate) fn is_behind(&self) -> bool {
        self.recorder.is_behind()
    }

    /// Closes the files and writes the report.
    pub(crate) fn close(
        self,
        within: Duration,
        scenario: &Scenario,
        host: &Host,
        stops: Option<Stops>,
    ) -> Closed {
        let Self { folder, recorder, fold, began } = self;
        let finished = recorder.finish(within);
        let logs = folder.is_some().then(|| Logs {
            journal: finished.journal.as_ref().map(|path| path.display().to_string()),
            recording: finished.recording.as_ref().map(|path| path.display().to_string()),
            error: finished.error.clone(),
        });
        let summary = Summary {
            wall_time_s: Some(began.elapsed().as_secs_f64()),
            events_sha256: finished.events_sha256.clone(),
            planner_calls: Some(headless::planner_calls(host)),
            stops,
            logs,
            ..fold.summary()
        };
        let summary = scenario.expect.evaluated(summary);
        let kept = folder.map(|folder| {
            let report = folder.write_report(&summary);
            Kept::new(&folder, &finished, &report)
        });
        Closed { summary, kept }
    }
}
