//! Closes a run that was killed while it was being written. The report records the digests of the existing files, who
//! closed the run and when, and the missing parts. Neither the journal nor the recording is changed.

use crate::{
    error::RunError, folder::RunFolder, past::Past, report_file::Reported, standing::held, utc_minute,
};
use account::{Logs, Summary};
use recording::{JournalError, recorded_failure, remove_reserve};
use report::document::Recovered;
use std::{path::Path, time::SystemTime};

/// The figures that the killed process would have added at the end.
const BY_THE_CLOCK: &str = "wall-clock figures: computing time, planner calls, stops";
/// The parts that are missing from a recording that was not closed.
const OF_RECORDING: &str = "the index of the recording, and up to 5 s of data that had not been written yet";

/// Closes the run in a folder if its writer was killed.
///
/// # Errors
/// A process is still writing to the run; the run has already been closed; its journal is empty or cannot be read; or the
/// system refuses to write the report.
pub fn recover(folder: &Path, by: &str) -> Result<Recovered, RunError> {
    let run = RunFolder::take(folder)?;
    refuse_closed(folder)?;
    let past = Past::read(folder).map_err(|error| explained(error, folder))?;
    let recovered =
        Recovered { by: by.to_owned(), at: utc_minute(SystemTime::now()), missing: missing(folder, &past) };
    let files = &past.run.files;
    let summary = Summary {
        events_sha256: files.journal_sha256.clone(),
        recording_sha256: files.recording_sha256.clone(),
        // No other process holds the lock.
        logs: Some(Logs { is_open: false, ..past.run.logs.clone() }),
        ..past.run.summary.clone()
    };
    // The draft left behind by the killed writer is reused.
    run.write_report_of(&summary, Some(&recovered))?;
    remove_reserve(folder);
    Ok(recovered)
}

/// Refuses a run that already has a report.
fn refuse_closed(folder: &Path) -> Result<(), RunError> {
    let refused = |why: String| Err(RunError::Refused(format!("{why}: {}", folder.display())));
    match Reported::read(folder) {
        Ok(None) => Ok(()),
        Ok(Some(report)) => refused(match report.recovered() {
            Some(Recovered { by, at, .. }) => {
                format!("the run was already recovered by {by}, {at} UTC; nothing was changed")
            }
            None => {
                "the run has a report, so it was closed when it ended; there is nothing to recover".into()
            }
        }),
        Err(why) => refused(format!("the run was closed when it ended, and {why}; restore the file")),
    }
}

/// The reason why nothing can be recovered from a journal.
fn explained(error: RunError, folder: &Path) -> RunError {
    match error {
        RunError::Journal(JournalError::NotOpened { .. }) => RunError::Refused(format!(
            "the run was killed before anything was written to its journal; there is nothing to recover, and the folder can be removed: {}",
            folder.display()
        )),
        error => error,
    }
}

/// The parts that are missing from a run.
fn missing(folder: &Path, past: &Past) -> Vec<String> {
    let run = &past.run;
    let mut missing = Vec::new();
    if run.summary.outcome.is_none() {
        let torn = run.logs.error.as_ref().map(|why| format!(" ({why})")).unwrap_or_default();
        missing.push(format!("the end of the mission: {}{torn}", held(&run.summary)));
    }
    missing.push(match run.files.recording_sha256 {
        Some(_) => OF_RECORDING.to_owned(),
        None => "the recording".to_owned(),
    });
    missing.push(BY_THE_CLOCK.to_owned());
    missing.extend(recorded_failure(folder).map(|why| format!("the data that could not be written: {why}")));
    missing
}

#[cfg(test)]
mod tests;
