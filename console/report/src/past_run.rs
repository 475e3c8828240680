//! A past run in the form in which reports use it.

use crate::{document::Files, record::Record};
use account::{Fold, Logs, Summary};

/// A past run: its name, its files and their contents.
#[derive(Debug)]
pub struct PastRun {
    /// Name of the run's folder.
    pub name: String,
    /// The files of the run.
    pub logs: Logs,
    /// Start time, UTC, as `2026-11-22 04:01`, if the folder name contains it.
    pub began: Option<String>,
    /// Digests and lengths of the run's files.
    pub files: Files,
    /// The events of the run, folded.
    pub fold: Fold,
    /// The figures of the run, computed from the events, with the account of the floor.
    pub summary: Summary,
    /// The record of the run over time and place.
    pub record: Record,
}

impl PastRun {
    /// Whether the run consists of located readings and is not a mission.
    pub(crate) fn is_located(&self) -> bool {
        self.fold.run().is_some_and(|run| run.measured.is_some())
    }
}
