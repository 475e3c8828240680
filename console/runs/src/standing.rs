//! The status of a past run, derived from its report, its journal and the files left by its writer.

use crate::{budget::Budget, files::LOCK_FILE, report_file::Reported};
use account::Summary;
use foreign::open_regular;
use recording::recorded_failure;
use std::{fs::TryLockError, path::Path};

/// The status of a past run.
#[derive(Debug, Clone, PartialEq)]
pub enum Standing {
    /// The run ended, and its report agrees with its journal.
    Ended(Box<Summary>),
    /// The run ended, but its journal or its recording is incomplete, as the report itself states.
    NotRecorded(Box<Summary>, String),
    /// A process is still writing to the run.
    Running,
    /// The run has no report that can be trusted; the journal is the only record.
    JournalOnly {
        /// The problem with the report; absent if the run has none.
        doubt: Option<String>,
        /// The reason why the writer could no longer write; absent if it was killed.
        failure: Option<String>,
    },
}

/// Determines the status of the run in a folder.
///
/// The journal is authoritative and the report is derived from it, so a report that cannot be read or disagrees with the
/// journal is ignored.
pub fn standing(folder: &Path) -> Standing {
    standing_within(folder, &Budget::of_one_run())
}

/// Like [`standing()`], but within a budget.
pub(crate) fn standing_within(folder: &Path, budget: &Budget) -> Standing {
    let failure = recorded_failure(folder);
    let summary = Reported::read(folder)
        .and_then(|reported| reported.map(|reported| reported.summary(folder, budget)).transpose());
    let doubt = match summary {
        Ok(Some(summary)) => return reported(summary, failure),
        Ok(None) => None,
        Err(why) => Some(why),
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
    Standing::NotRecorded(summary, error.unwrap_or_else(|| "the journal is incomplete".into()))
}

/// Whether a process is writing to the run in a folder.
pub(crate) fn is_locked(folder: &Path) -> bool {
    let locked = open_regular(&folder.join(LOCK_FILE))
        .map(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)));
    locked.unwrap_or(false)
}

/// The point up to which an incomplete journal extends.
pub(crate) fn held(summary: &Summary) -> String {
    summary.mission_time_s.map_or_else(
        || "the journal is empty".into(),
        |until_s| format!("the journal holds everything up to T+{}", account::clock(until_s)),
    )
}
