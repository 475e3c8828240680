//! Closes a run whose writer did not close it: the writer was killed, or could not finish in time. The report records the
//! digests of the files, who closed the run and when, and the missing parts. A journal is never changed. If the journal
//! contains the end of the mission, the recording and the readings are made again from it; otherwise they stay as they are.
//! A report whose figures go beyond the journal is kept as a copy.

use crate::{
    error::RunError,
    files::REPORT_FILE,
    folder::RunFolder,
    past::Past,
    report_file::Reported,
    standing::held,
    utc_minute,
    whole::{draft_of, write_whole},
};
use account::{Expect, Logs, Summary};
use mission::RunOpened;
use recording::{
    JournalError, READINGS_FILE, RECORDING_FILE, RecordingError, journal_of, recorded_failure,
    remove_failure, remove_reserve, sha256,
};
use report::document::Recovered;
use std::{fs, io, path::Path, time::SystemTime};

/// The copy of the report that the run wrote at its end, if that report goes beyond the journal.
const KEPT_REPORT_FILE: &str = "report-before-recovery.json";
/// The figures that the writer would have added at the end.
const BY_THE_CLOCK: &str = "wall-clock figures: computing time, planner calls, stops";
/// The parts that are missing from a recording that was not closed.
const OF_RECORDING: &str = "the index of the recording, and up to 5 s of data that had not been written yet";
/// The missing result of the scenario's expectations.
const EXPECTATIONS: &str =
    "the comparison with [expect]: this version of tankops cannot read the scenario of the run";

/// Closes the run in a folder if its writer did not. `expect` returns the expectations of the scenario of the run, or
/// `None` if the scenario cannot be read.
///
/// # Errors
/// A process is still writing to the run; the run has already been closed; a file was changed since then; the journal is
/// empty or cannot be read; or the system refuses to write a file.
pub fn recover(
    folder: &Path,
    by: &str,
    expect: impl FnOnce(&RunOpened) -> Option<Expect>,
) -> Result<Recovered, RunError> {
    let run = RunFolder::take(folder)?;
    let unclosed = unclosed(folder)?;
    let past = Past::read(folder).map_err(|error| explained(error, folder))?;
    if let Some(doubt) = unclosed
        .as_ref()
        .and_then(|report| report.reported.journal_doubt(past.run.files.journal_sha256.as_deref()))
    {
        return Err(refused(folder, &format!("{doubt}; restore the journal")));
    }
    let by_the_clock = unclosed.as_ref().map(|report| &*report.summary);
    let is_whole = past.run.summary.outcome.is_some();
    let expect = if is_whole { expect(&past.opened) } else { None };
    let missing = missing(folder, &past, (by_the_clock, expect.as_ref()));
    let recovered = Recovered { by: by.to_owned(), at: utc_minute(SystemTime::now()), missing };
    if by_the_clock.is_some_and(|report| goes_beyond(report, &past.run.summary)) {
        keep_report(folder)?;
    }
    let made = if is_whole { Some(made_again(folder, &past)?) } else { None };
    let summary = closed(&past, made, by_the_clock);
    let summary = match expect {
        Some(expect) => expect.evaluated(summary),
        None => summary,
    };
    // The draft left behind by the writer is reused.
    run.write_report_of(&summary, Some(&recovered))?;
    remove_reserve(folder);
    if is_whole {
        remove_failure(folder);
    }
    Ok(recovered)
}

/// The figures of the report; `made` are the digests of the recording and the readings if they were made again.
fn closed(past: &Past, made: Option<[Option<String>; 2]>, by_the_clock: Option<&Summary>) -> Summary {
    let files = &past.run.files;
    let clock = by_the_clock.cloned().unwrap_or_default();
    // No other process holds the lock.
    let logs = Logs { is_open: false, ..past.run.logs.clone() };
    let logs = match &made {
        // The recording may have been missing before.
        Some(_) => Logs { error: None, recording: Some(recording_of(past)), ..logs },
        None => logs,
    };
    let [recording_sha256, readings_sha256] = made.unwrap_or_else(|| [files.recording_sha256.clone(), None]);
    Summary {
        events_sha256: files.journal_sha256.clone(),
        recording_sha256,
        readings_sha256,
        wall_time_s: clock.wall_time_s,
        planner_calls: clock.planner_calls,
        stops: clock.stops,
        logs: Some(logs),
        ..past.run.summary.clone()
    }
}

/// Whether a report has figures of a part of the mission that is missing from the journal.
fn goes_beyond(report: &Summary, journal: &Summary) -> bool {
    report.ticks > journal.ticks || report.outcome.is_some() && journal.outcome.is_none()
}

/// Keeps the report of a run under another name.
fn keep_report(folder: &Path) -> Result<(), RunError> {
    let copy = folder.join(KEPT_REPORT_FILE);
    let kept = fs::read(folder.join(REPORT_FILE)).and_then(|report| write_whole(&copy, &report));
    kept.map_err(RunError::during(format!("writing {}", copy.display())))
}

/// The path of the recording, beside the journal.
fn recording_of(past: &Past) -> String {
    let journal = past.run.logs.journal.as_deref().unwrap_or_default();
    Path::new(journal).with_file_name(RECORDING_FILE).display().to_string()
}

/// Makes the recording and the readings of a run again from its journal, and returns their SHA-256; that of the readings
/// is absent if the run has none.
fn made_again(folder: &Path, past: &Past) -> Result<[Option<String>; 2], RunError> {
    let recording = replaced(folder, RECORDING_FILE, recording::export)?;
    let has_readings = past.run.fold.survey().is_some();
    let readings = has_readings.then(|| replaced(folder, READINGS_FILE, recording::export_readings));
    Ok([Some(recording), readings.transpose()?])
}

/// Replaces a file in the folder of a run by one that is made from its journal; returns its SHA-256, hexadecimal. If this
/// fails, the file is as it was.
fn replaced(
    folder: &Path,
    name: &str,
    make: fn(&Path, &Path) -> Result<Option<String>, RecordingError>,
) -> Result<String, RunError> {
    let (file, journal) = (folder.join(name), journal_of(folder));
    let draft = draft_of(&file);
    let writing = || format!("writing {}", file.display());
    match fs::remove_file(&draft) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            return Err(RunError::during(writing())(error));
        }
        _ => {}
    }
    let replace = || {
        make(&journal, &draft)?;
        fs::rename(&draft, &file).map_err(RunError::during(writing()))?;
        sha256(&file).map_err(RunError::during(writing()))
    };
    replace().inspect_err(|_: &RunError| drop(fs::remove_file(&draft)))
}

/// A report whose writer could not close the run, with the figures that only the writer knew.
struct Unclosed {
    reported: Reported,
    summary: Box<Summary>,
}

/// The report of a run that was not closed; `None` without a report. Refuses a run that was closed.
fn unclosed(folder: &Path) -> Result<Option<Unclosed>, RunError> {
    let refused = |why: &str| Err(refused(folder, why));
    let reported = match Reported::read(folder) {
        Ok(None) => return Ok(None),
        Ok(Some(reported)) => reported,
        Err(why) => {
            return refused(&format!("the run was closed when it ended, and {why}; restore the file"));
        }
    };
    if let Some(Recovered { by, at, .. }) = reported.recovered() {
        return refused(&format!("the run was already recovered by {by}, {at} UTC; nothing was changed"));
    }
    match reported.unclosed() {
        Ok(Some(summary)) => Ok(Some(Unclosed { reported, summary })),
        Ok(None) => {
            refused("the run has a report, so it was closed when it ended; there is nothing to recover")
        }
        Err(why) => refused(&format!("{why}; restore {REPORT_FILE}")),
    }
}

fn refused(folder: &Path, why: &str) -> RunError {
    RunError::Refused(format!("{why}: {}", folder.display()))
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

/// The parts that are missing from a run; `known` are the figures that the writer had added, and the expectations of the
/// scenario, as far as they are known.
fn missing(folder: &Path, past: &Past, known: (Option<&Summary>, Option<&Expect>)) -> Vec<String> {
    let run = &past.run;
    let (by_the_clock, expect) = known;
    let mut missing = Vec::new();
    if run.summary.outcome.is_none() {
        let torn = run.logs.error.as_ref().map(|why| format!(" ({why})")).unwrap_or_default();
        missing.push(format!("the end of the mission: {}{torn}", held(&run.summary)));
        missing.push(match run.files.recording_sha256 {
            Some(_) => OF_RECORDING.to_owned(),
            None => "the recording".to_owned(),
        });
        missing
            .extend(recorded_failure(folder).map(|why| format!("the data that could not be written: {why}")));
    } else if expect.is_none() {
        missing.push(EXPECTATIONS.to_owned());
    }
    if by_the_clock.is_some_and(|report| goes_beyond(report, &run.summary)) {
        missing.push(format!(
            "the figures of the whole mission: they are only in the report that the run wrote at its end, which was \
             kept as {KEPT_REPORT_FILE}"
        ));
    }
    if by_the_clock.is_none() {
        missing.push(BY_THE_CLOCK.to_owned());
    }
    missing
}

#[cfg(test)]
mod tests;
