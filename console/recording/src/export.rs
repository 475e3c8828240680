//! Regenerates the recording from the journal.

use crate::{error::RecordingError, identity::Identity, journal::JournalReader, recorder::Recorder};
use account::Fold;
use std::{path::Path, time::Instant};

/// Regenerates the recording of a run from its journal, equal in content to the one that was made while it ran.
///
/// The recording is that of the run to which the journal belongs (the name of its folder), wherever it is put. A
/// journal that is cut off gives a recording up to there; what is missing is returned.
///
/// # Errors
/// No journal, a damaged one, or the recording cannot be written; an existing recording is never written over.
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
