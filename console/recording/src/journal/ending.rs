//! How a journal ends, without reading all of it.

use crate::file::open_regular;
use mission::{Event, EventKind};
use std::{
    io::{self, Read, Seek, SeekFrom},
    path::Path,
};

/// How much of the end is read, bytes; the event `ended` is the last of its run.
const TAIL_BYTES: u64 = 64 * 1024;

/// The event with which the run of a journal ended; none if the journal stops before that.
///
/// Only the last 64 kB are read: this is for lists of many runs, and proves nothing of what comes before.
///
/// # Errors
/// The file cannot be read.
pub fn read_ending(path: &Path) -> io::Result<Option<Event>> {
    let mut file = open_regular(path)?;
    let length = file.metadata()?.len();
    file.seek(SeekFrom::Start(length.saturating_sub(TAIL_BYTES)))?;
    let mut tail = Vec::new();
    // A journal that is being written may grow meanwhile.
    file.take(TAIL_BYTES).read_to_end(&mut tail)?;
    let parsed = tail.rsplit(|byte| *byte == b'\n').filter_map(|line| serde_json::from_slice(line).ok());
    Ok(parsed.into_iter().find(|event: &Event| matches!(event.kind, EventKind::Ended { .. })))
}
