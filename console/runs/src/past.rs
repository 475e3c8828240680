//! Past runs, read from their journals.

use crate::{error::RunError, report_file::journal_doubt};
use mission::{EventKind, RunOpened};
use recording::{JOURNAL_FILE, JournalError, JournalReader, RECORDING_FILE, sha256};
use report::{Fold, Logs, PastRun};
use std::path::Path;
use world::{CellRun, Floor};

/// A past run.
#[derive(Debug)]
pub struct Past {
    /// How it was opened.
    pub opened: Box<RunOpened>,
    /// Its events, folded, and its files.
    pub run: PastRun,
    /// Tick of the first event that names cells beyond those of the floor, which no run does: the journal was changed.
    pub beyond_floor: Option<u64>,
}

impl Past {
    /// Reads the run in a folder. What speaks against its journal is in its logs, as an error.
    ///
    /// # Errors
    /// Its journal cannot be read.
    pub fn read(folder: &Path) -> Result<Self, RunError> {
        let journal = folder.join(JOURNAL_FILE);
        let mut reader = JournalReader::open(&journal)?;
        let (mut fold, mut opened, mut beyond_floor) = (Fold::new(), None, None);
        for event in reader.by_ref() {
            let event = event?;
            fold.apply(&event);
            match (event.kind, &opened) {
                (EventKind::RunOpened(run), None) => opened = Some(run),
                (EventKind::Covered { runs } | EventKind::Uncounted { runs }, Some(opened))
                    if names_cells_beyond(&opened.floor, &runs) =>
                {
                    beyond_floor.get_or_insert(event.tick);
                }
                _ => {}
            }
        }
        let opened = opened.ok_or(JournalError::NotOpened)?;
        let recording = folder.join(RECORDING_FILE);
        let journal_sha256 = sha256(&journal).ok();
        let doubt = journal_doubt(folder, journal_sha256.as_deref());
        let shown = |path: &Path| path.exists().then(|| path.display().to_string());
        let run = PastRun {
            name: folder.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            logs: Logs {
                journal: shown(&journal),
                recording: shown(&recording),
                error: doubt.or_else(|| reader.truncated().map(str::to_owned)),
            },
            recording_sha256: sha256(&recording).ok(),
            journal_sha256,
            fold,
        };
        Ok(Self { opened, run, beyond_floor })
    }
}

fn names_cells_beyond(floor: &Floor, runs: &[CellRun]) -> bool {
    runs.iter().any(|CellRun(first, count)| u64::from(*first) + u64::from(*count) > floor.len() as u64)
}
