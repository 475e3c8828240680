//! How a past run stands, by its report, its journal and the signs that its writer left.

use super::{JOURNAL_FILE, LOCK_FILE, REPORT_FILE, sha256};
use mission::{Event, EventKind};
use recording::{read_ending, recorded_failure};
use report::Summary;
use serde::{Deserialize, Serialize};
use std::{
    fs::{self, File, Metadata, TryLockError},
    io,
    path::Path,
    time::SystemTime,
};

/// A report as it is written to disk: with the length of the journal that it was made from.
#[derive(Serialize)]
pub(super) struct ReportFile<'a> {
    #[serde(flatten)]
    pub(super) summary: &'a Summary,
    /// Absent if there is no journal any more.
    pub(super) journal_bytes: Option<u64>,
}

/// What a report says of the journal that it was made from.
#[derive(Deserialize)]
struct Source {
    events_sha256: Option<String>,
    #[serde(default)]
    journal_bytes: Option<u64>,
}

/// How a past run stands.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Standing {
    /// It ended, and its report agrees with its journal.
    Ended(Box<Summary>),
    /// It ended, but its journal or its recording is not whole, as the report itself says.
    NotRecorded(Box<Summary>, String),
    /// Somebody is writing to it.
    Running,
    /// It has no report that can be believed: only the journal says what happened.
    JournalOnly {
        /// What is wrong with its report; absent if there is none.
        doubt: Option<String>,
        /// Why its writer could not write, if it could not; otherwise it was killed.
        failure: Option<String>,
    },
}

/// How the run in a folder stands.
///
/// The journal is the truth and the report a copy of what it says: a report that cannot be read, or does not fit the
/// journal, counts for nothing.
pub(crate) fn standing(folder: &Path) -> Standing {
    let failure = recorded_failure(folder);
    let doubt = match fs::read_to_string(folder.join(REPORT_FILE)) {
        Ok(text) => match read_report(folder, &text) {
            Ok(summary) => return reported(summary, failure),
            Err(why) => Some(why),
        },
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => Some(format!("{REPORT_FILE} cannot be read: {error}")),
    };
    if doubt.is_none() && is_locked(folder) {
        return Standing::Running;
    }
    Standing::JournalOnly { doubt, failure }
}

fn reported(summary: Box<Summary>, failure: Option<String>) -> Standing {
    if summary.events_sha256.is_some() {
        return Standing::Ended(summary);
    }
    let error = summary.logs.as_ref().and_then(|logs| logs.error.clone()).or(failure);
    Standing::NotRecorded(summary, error.unwrap_or_else(|| "the journal is not whole".into()))
}

fn is_locked(folder: &Path) -> bool {
    let locked = File::open(folder.join(LOCK_FILE))
        .map(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)));
    locked.unwrap_or(false)
}

/// The report, if it can be read and fits the journal.
fn read_report(folder: &Path, text: &str) -> Result<Box<Summary>, String> {
    let damaged = |error: serde_json::Error| format!("{REPORT_FILE} is damaged: {error}");
    let summary: Summary = serde_json::from_str(text).map_err(damaged)?;
    let source: Source = serde_json::from_str(text).map_err(damaged)?;
    // A report that says itself that the journal is not whole claims nothing about it.
    let Some(then) = &source.events_sha256 else { return Ok(Box::new(summary)) };
    let path = folder.join(JOURNAL_FILE);
    let no_journal = |error| format!("{JOURNAL_FILE} cannot be read: {error}");
    if !is_untouched(folder, &source).map_err(no_journal)? && sha256(&path).map_err(no_journal)? != *then {
        return Err(NOT_THE_ONE.to_owned());
    }
    match read_ending(&path).map_err(no_journal)? {
        Some(ending) if agrees(&summary, &ending) => Ok(Box::new(summary)),
        _ => Err(format!("{REPORT_FILE} was changed: it does not end as the journal does")),
    }
}

/// What is said of a journal that its report was not made from.
const NOT_THE_ONE: &str =
    "the journal is not the one that was written: it does not have the SHA-256 of the report";

/// Whether the journal has the length that the report names and was not written after it; then it is not hashed.
///
/// This is for lists; whoever must be sure reads the journal ([`journal_doubt`]).
fn is_untouched(folder: &Path, source: &Source) -> io::Result<bool> {
    let (journal, report) =
        (fs::metadata(folder.join(JOURNAL_FILE))?, fs::metadata(folder.join(REPORT_FILE))?);
    let written = |file: &Metadata| file.modified().unwrap_or(SystemTime::UNIX_EPOCH);
    Ok(source.journal_bytes == Some(journal.len()) && written(&journal) <= written(&report))
}

fn agrees(summary: &Summary, ending: &Event) -> bool {
    let EventKind::Ended { outcome, reason } = &ending.kind else { return false };
    summary.outcome == Some(*outcome)
        && summary.reason.as_ref() == Some(reason)
        && summary.ticks == Some(ending.tick)
}

/// What speaks against the journal of a run whose digest is this: its report names another one, or cannot be read.
pub(crate) fn journal_doubt(folder: &Path, sha256: Option<&str>) -> Option<String> {
    let text = match fs::read_to_string(folder.join(REPORT_FILE)) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return None,
        Err(error) => return Some(format!("{REPORT_FILE} cannot be read: {error}")),
    };
    match serde_json::from_str::<Source>(&text) {
        Ok(source) => (source.events_sha256? != sha256?).then(|| NOT_THE_ONE.to_owned()),
        Err(error) => Some(format!("{REPORT_FILE} is damaged: {error}")),
    }
}

/// What contradicts a journal without an end: the run has a report, so it was closed cleanly.
pub(crate) fn end_is_missing(folder: &Path) -> Option<String> {
    let report: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.join(REPORT_FILE)).ok()?).ok()?;
    report.get("outcome")?.as_str()?;
    Some("the run has a report, so it came to its end, but the journal has none".to_owned())
}
