//! What a journal says in short: how it ends, and the digest of its lines.

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
    let tail = tail_of(Lines::of(file, path, FrameStart::default())?.text())?;
    let parsed = tail
        .rsplit(|byte| *byte == b'\n')
        .filter(|line| is_light(line))
        .filter_map(|line| serde_json::from_slice(line).ok());
    Ok(parsed.into_iter().find(|event: &Event| matches!(event.kind, EventKind::Ended { .. })))
}

/// The last bytes that a reader gives, a good deal more than [`TAIL_BYTES`].
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
/// It is not a regular file, or cannot be read or decompressed.
pub fn events_sha256(path: &Path) -> io::Result<String> {
    events_sha256_while(path, |_| true)
}

/// [`events_sha256`], given up as soon as `goes_on` says so, which hears how many bytes of lines were read.
///
/// # Errors
/// As [`events_sha256`]; [`io::ErrorKind::Interrupted`] if it was given up.
pub fn events_sha256_while(path: &Path, goes_on: impl FnMut(u64) -> bool) -> io::Result<String> {
    let mut lines = Lines::of(open_regular(path)?, path, FrameStart::default())?;
    digest(lines.text(), goes_on)
}
