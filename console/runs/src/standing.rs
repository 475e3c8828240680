//! How a past run stands, by its report, its journal and the signs that its writer left.

use crate::{budget::Budget, files::LOCK_FILE, report_file::Reported};
use account::Summary;
use foreign::open_regular;
use recording::recorded_failure;
use std::{fs::TryLockError, path::Path};

/// How a past run stands.
#[derive(Debug, Clone, PartialEq)]
pub enum Standing {
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
pub fn standing(folder: &Path) -> Standing {
    standing_within(folder, &Budget::of_one_run())
}

/// [`standing()`], read within a budget.
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
    Standing::NotRecorded(summary, error.unwrap_or_else(|| "the journal is not whole".into()))
}

/// Whether somebody is writing to the run in a folder.
pub(crate) fn is_locked(folder: &Path) -> bool {
    let locked = open_regular(&folder.join(LOCK_FILE))
        .map(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)));
    locked.unwrap_or(false)
}

/// Up to when a journal that stops early goes.
pub(crate) fn held(summary: &Summary) -> String {
    summary.mission_time_s.map_or_else(
        || "the journal is empty".into(),
        |until_s| format!("the journal holds everything up to T+{until_s:.1} s"),
    )
}
