//! What a journal says in short: how it ends, and the digest of its lines.

use super::{
    frames,
    lines::{Lines, is_packed},
    unpacker::FrameStart,
};
use crate::{file::open_regular, identity::hexadecimal};
use mission::{Event, EventKind};
use sha2::{Digest, Sha256};
use std::{
    io::{self, Seek, SeekFrom},
    path::Path,
};

/// How much of the end of a journal without frames is read, bytes; the event `ended` is the last of its run.
const TAIL_BYTES: u64 = 64 * 1024;

/// The event with which the run of a journal ended; none if the journal stops before that.
///
/// Only its last frame, or the last 64 kB, are read: this is for lists of many runs, and proves nothing of what comes before.
///
/// # Errors
/// The file cannot be read.
pub fn read_ending(path: &Path) -> io::Result<Option<Event>> {
    let mut file = open_regular(path)?;
    let start = if is_packed(path) {
        frames::starts(&file)?.last().copied().unwrap_or_default()
    } else {
        file.metadata()?.len().saturating_sub(TAIL_BYTES)
    };
    file.seek(SeekFrom::Start(start))?;
    let mut tail = Vec::new();
    Lines::of(file, path, FrameStart::default())?.text().read_to_end(&mut tail)?;
    let parsed = tail.rsplit(|byte| *byte == b'\n').filter_map(|line| serde_json::from_slice(line).ok());
    Ok(parsed.into_iter().find(|event: &Event| matches!(event.kind, EventKind::Ended { .. })))
}

/// SHA-256 of the lines of a journal, hexadecimal: equal for equal runs.
///
/// # Errors
/// It is no regular file, or cannot be read or decompressed.
pub fn events_sha256(path: &Path) -> io::Result<String> {
    let mut lines = Lines::of(open_regular(path)?, path, FrameStart::default())?;
    let (mut hasher, mut chunk) = (Sha256::new(), vec![0; 1 << 18]);
    loop {
        match lines.text().read(&mut chunk)? {
            0 => return Ok(hexadecimal(&hasher.finalize())),
            length => hasher.update(&chunk[..length]),
        }
    }
}
