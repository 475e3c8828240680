//! Reads how a journal ends, and computes the digest of its lines.

use super::{
    frames,
    limits::is_light,
    lines::{Lines, is_packed},
    unpacker::FrameStart,
};
use crate::file::digest;
use foreign::open_regular;
use mission::{Event, EventKind};
use std::{
    io::{self, Read, Seek, SeekFrom},
    path::Path,
};

/// Number of bytes read from the end of an uncompressed journal; the event `ended` is the last event of a run.
const TAIL_BYTES: u64 = 64 * 1024;

/// The final event of a journal; `None` if the journal stops before it.
///
/// Only the last frame, or the last 64 kB, is read. This is for lists of many runs, and proves nothing about the
/// earlier part of the journal.
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
    let tail = tail_of(Lines::of(file, path, FrameStart::default())?.text())?;
    let parsed = tail
        .rsplit(|byte| *byte == b'\n')
        .filter(|line| is_light(line))
        .filter_map(|line| serde_json::from_slice(line).ok());
    Ok(parsed.into_iter().find(|event: &Event| matches!(event.kind, EventKind::Ended { .. })))
}

/// The last bytes of a reader, up to 16 times [`TAIL_BYTES`].
fn tail_of(lines: &mut dyn Read) -> io::Result<Vec<u8>> {
    let most = 16 * TAIL_BYTES as usize;
    let (mut tail, mut chunk) = (Vec::new(), vec![0; most]);
    loop {
        let length = lines.read(&mut chunk)?;
        tail.extend_from_slice(&chunk[..length]);
        if length == 0 {
            return Ok(tail);
        }
        let surplus = tail.len().saturating_sub(most);
        tail.drain(..surplus);
    }
}

/// SHA-256 of the lines of a journal, hexadecimal: equal for equal runs.
///
/// # Errors
/// The file is not a regular file, or cannot be read or decompressed.
pub fn events_sha256(path: &Path) -> io::Result<String> {
    events_sha256_while(path, |_| true)
}

/// Like [`events_sha256`], but stops as soon as `goes_on` returns `false`; `goes_on` receives the number of bytes of
/// lines read.
///
/// # Errors
/// Those of [`events_sha256`], and [`io::ErrorKind::Interrupted`] if it was stopped.
pub fn events_sha256_while(path: &Path, goes_on: impl FnMut(u64) -> bool) -> io::Result<String> {
    let mut lines = Lines::of(open_regular(path)?, path, FrameStart::default())?;
    digest(lines.text(), goes_on)
}
