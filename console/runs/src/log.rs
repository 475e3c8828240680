//! Writes the journal and the recording of a run while its mission runs, and the report at its end.

use crate::{beside::Beside, error::RunError, folder::RunFolder, kept::Kept};
use account::{Expect, Logs, PlannerCalls, Stops, Summary};
use mission::{Event, EventKind};
use recording::{Health, JournalWriter, Options, RunRecorder, sha256};
use std::{
    path::Path,
    sync::{Arc, mpsc::Sender},
    time::{Duration, Instant, SystemTime},
};

/// Longest time that closing a run may take; then the attempt is abandoned with a message.
pub const CLOSE_TIMEOUT: Duration = Duration::from_secs(10);

/// A run that is being written or, if it has no folder, only computed.
pub struct RunLog {
    folder: Option<RunFolder>,
    beside: Option<Beside>,
    recorder: RunRecorder,
    /// The summary to return if the recorder does not finish in time.
    least: Summary,
    began: Instant,
}

/// A run that has ended.
pub struct Closed {
    /// The report.
    pub summary: Summary,
    /// Whether the run is on disk; `None` if it was not to be kept.
    pub kept: Option<Kept>,
}

impl RunLog {
    /// Creates the folder of the run and its files.
    ///
    /// # Errors
    /// The folder or the files cannot be created.
    pub fn create(logs: &Path, scenario: &str, planner: &str, seed: u64) -> Result<Self, RunError> {
        check_clock(SystemTime::now())?;
        let folder = RunFolder::create(logs, scenario, planner, seed)?;
        let recorder = RunRecorder::start(folder.path(), Options::default())?;
        let beside = Some(Beside::new(folder.path()));
        Ok(Self { folder: Some(folder), beside, recorder, least: Summary::default(), began: Instant::now() })
    }

    /// From now on, flushes the journal to disk every second.
    ///
    /// # Errors
    /// The system cannot create a thread.
    pub fn sync(&mut self) -> Result<(), RunError> {
        Ok(self.recorder.sync()?)
    }

    /// Writes nothing, but computes the report and the hash.
    ///
    /// # Errors
    /// The system cannot create a thread.
    pub fn unwritten() -> Result<Self, RunError> {
        let began = Instant::now();
        let recorder = RunRecorder::spawn(JournalWriter::unwritten(began), None)?;
        Ok(Self { folder: None, beside: None, recorder, least: Summary::default(), began })
    }

    /// Takes the events of a tick; they are copied unless they are shared. Waits while the recorder's queue is full.
    pub fn keep(&mut self, events: impl Into<Arc<[Event]>>) {
        let events = events.into();
        if let Some(event) = events.last() {
            (self.least.ticks, self.least.mission_time_s) = (Some(event.tick), Some(event.t_s));
        }
        for event in &*events {
            if let EventKind::Ended { outcome, reason } = &event.kind {
                (self.least.outcome, self.least.reason) = (Some(*outcome), Some(reason.clone()));
            }
        }
        self.recorder.send(events);
    }

    /// Saves lines that planners printed, in a file beside the journal.
    pub fn keep_output(&mut self, text: &str) {
        if let Some(beside) = &mut self.beside {
            beside.keep_output(text);
        }
    }

    /// Saves the crash files of a planner that failed, in a separate folder; `files` lists them by name.
    pub fn keep_crash(&mut self, files: &[(&str, Vec<u8>)]) {
        if let Some(beside) = &mut self.beside {
            beside.keep_crash(files);
        }
    }

    /// Hands the journal to the system, including all events that were taken before, and then answers. Nothing waits for
    /// the answer.
    pub fn flush(&self, done: Sender<()>) {
        self.recorder.flush(done);
    }

    /// How far recording has progressed.
    pub fn health(&self) -> Health {
        self.recorder.health()
    }

    /// Whether the recorder's queue is so long that the caller should wait before sending more.
    pub fn is_behind(&self) -> bool {
        self.recorder.is_behind()
    }

    /// Closes the files and writes the report. The report also contains data that is not in the events: wall-clock
    /// figures about planner calls and stops, and the expectations of the scenario.
    pub fn close(
        self,
        within: Duration,
        calls: PlannerCalls,
        stops: Option<Stops>,
        expect: &Expect,
    ) -> Closed {
        let Self { folder, recorder, least, began, .. } = self;
        let mut finished = recorder.finish(within);
        let logs = folder.is_some().then(|| Logs {
            journal: finished.journal.as_ref().map(|path| path.display().to_string()),
            recording: finished.recording.as_ref().map(|path| path.display().to_string()),
            error: finished.error.clone(),
            is_open: false,
        });
        let summary = Summary {
            wall_time_s: Some(began.elapsed().as_secs_f64()),
            events_sha256: finished.events_sha256.clone(),
            recording_sha256: finished.recording_sha256.clone().or_else(|| {
                // This may be incomplete, but it may still be useful.
                finished.recording.as_ref().and_then(|path| sha256(path).ok())
            }),
            planner_calls: Some(calls),
            stops,
            logs,
            ..finished.summary.take().map_or(least, |summary| *summary)
        };
        let summary = expect.evaluated(summary);
        let kept = folder.map(|folder| {
            let report = folder.write_report(&summary);
            Kept::new(&folder, &finished, &report)
        });
        Closed { summary, kept }
    }
}

/// A recording contains the machine's time, which must be a plausible date.
fn check_clock(now: SystemTime) -> Result<(), RunError> {
    if now >= SystemTime::UNIX_EPOCH {
        return Ok(());
    }
    Err(RunError::Machine(
        "no run can be recorded: the machine's clock is set to before 1970; correct it".into(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use mission::Outcome;

    #[test]
    fn a_clock_before_1970_is_named() {
        assert!(check_clock(SystemTime::now()).is_ok() && check_clock(SystemTime::UNIX_EPOCH).is_ok());
        let error = check_clock(SystemTime::UNIX_EPOCH - Duration::from_secs(1)).unwrap_err();
        assert_eq!(
            error.to_string(),
            "no run can be recorded: the machine's clock is set to before 1970; correct it"
        );
        assert!(!error.is_input());
    }

    #[test]
    fn a_run_whose_recorder_is_not_done_in_time_still_says_how_it_ended() {
        let mut log = RunLog::unwritten().unwrap();
        let kind = EventKind::Ended { outcome: Outcome::Aborted, reason: "the operator ended it".into() };
        log.keep([Event { tick: 7, t_s: 0.7, kind }]);
        let calls = PlannerCalls { plan: 0, step: 0, p50_us: None, p99_us: None, faults: 0 };
        let closed = log.close(Duration::ZERO, calls, None, &Expect::default());
        let Summary { ticks, outcome, reason, .. } = closed.summary;
        assert_eq!((ticks, outcome), (Some(7), Some(Outcome::Aborted)));
        assert_eq!(reason.as_deref(), Some("the operator ended it"));
    }
}
