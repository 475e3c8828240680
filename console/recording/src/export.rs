//! Regenerates the recording from the journal.

use crate::{error::RecordingError, identity::Identity, journal::JournalReader, recorder::Recorder};
use account::Fold;
use std::{path::Path, time::Instant};

/// Regenerates the recording of a run from its journal, with the same content as the recording made during the run.
///
/// The recording belongs to the run of the journal (the name of its folder), wherever the recording is stored. If the
/// journal is cut off, the recording extends to that point, and the returned text states what is missing.
///
/// # Errors
/// The journal is missing or damaged, or the recording cannot be written; an existing recording is never
/// overwritten.
pub fn export(journal: &Path, recording: &Path) -> Result<Option<String>, RecordingError> {
    let now = Instant::now();
    let mut reader = JournalReader::open(journal)?;
    let mut recorder = Recorder::create(recording, &Identity::of_file(journal), now)?;
    let mut account = Fold::new();
    for event in reader.by_ref() {
        let event = event?;
        recorder.push(&event, &account, now)?;
        account.apply(&event);
    }
    recorder.finish(&account.summary(), None)?;
    Ok(reader.truncated().map(str::to_owned))
}
