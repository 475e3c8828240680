//! The track of a past run, on which readings of an instrument are placed.

use account::{Fold, Track};
use mission::EventKind;
use recording::{JournalReader, journal_of};
use std::path::Path;

/// Reads the events of the run in a folder: its state at the end, and its track. The last value states what is missing
/// from a journal that is cut off.
///
/// # Errors
/// The journal cannot be read.
pub fn track(folder: &Path) -> anyhow::Result<(Fold, Track, Option<String>)> {
    let mut reader = JournalReader::open(&journal_of(folder))?;
    let (mut fold, mut track) = (Fold::new(), Track::default());
    for event in reader.by_ref() {
        let event = event?;
        fold.apply(&event);
        if let EventKind::Estimated { pose } = &event.kind {
            track.push(event.t_s, pose, fold.counts());
        }
    }
    if fold.run().is_none() {
        return Err(reader.not_opened().into());
    }
    Ok((fold, track, reader.truncated().map(str::to_owned)))
}
