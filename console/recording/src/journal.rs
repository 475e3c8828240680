//! The journal of a run: every event in order, one JSON object per line, compressed.
//!
//! The journal contains no wall-clock time, so equal runs have equal lines, byte for byte. Recording, report and replay
//! can be regenerated from the journal, and its format does not depend on the recording SDK.

mod ending;
mod fast;
mod follow;
mod frames;
mod limits;
mod lines;
mod packer;
mod plain;
mod reader;
mod ticks;
mod unpacker;
mod writer;

pub use ending::{events_sha256, events_sha256_while, read_ending};
pub use reader::{JournalLine, JournalPlace, JournalReader};
pub use ticks::{Difference, RecordedTick, Ticks};
pub use writer::{JournalEnd, JournalWriter};

use crate::file::FileChange;
use std::path::{Path, PathBuf};

/// Name of the journal in the folder of a run.
pub const JOURNAL_FILE: &str = "events.jsonl.zst";
/// Name of an uncompressed journal.
pub const PLAIN_JOURNAL_FILE: &str = "events.jsonl";

/// The path of the journal in the folder of a run, compressed or not; the path of a compressed one if there is none.
pub fn journal_of(folder: &Path) -> PathBuf {
    let (packed, plain) = (folder.join(JOURNAL_FILE), folder.join(PLAIN_JOURNAL_FILE));
    if !packed.exists() && plain.exists() { plain } else { packed }
}

/// The reason why a journal cannot be written or read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum JournalError {
    /// The file could not be created; an existing journal is never overwritten.
    #[error("cannot create the journal ({why}): {}", path.display())]
    Create {
        /// The error of the system.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// Writing failed; events are kept in memory until they can be written.
    #[error(
        "the journal cannot be written beyond {bytes} bytes ({why}); events are kept in memory until \
         writing succeeds"
    )]
    Stalled {
        /// Number of bytes written.
        bytes: u64,
        /// The error of the system.
        why: String,
    },
    /// Writing failed for good; the part that was already written is kept.
    #[error("the journal stopped after {bytes} bytes: {why}")]
    Write {
        /// Number of bytes written.
        bytes: u64,
        /// The error of the system.
        why: String,
    },
    /// The file on disk is not the file that was written.
    #[error("the journal on disk differs from what was written: {0}")]
    Changed(#[from] FileChange),
    /// The file could not be read.
    #[error("cannot read the journal ({why}): {}", path.display())]
    Read {
        /// The error of the system.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// The first line is not a `run_opened` event.
    #[error("this is not a journal: line 1 is not the event run_opened ({why}): {}", path.display())]
    NotAJournal {
        /// The fault of the line.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// The journal is empty, or is cut off within its first line.
    #[error("the journal is empty or cut off before the run was opened: {}", path.display())]
    NotOpened {
        /// The file.
        path: PathBuf,
    },
    /// The journal was written by a tankops with a different journal version.
    #[error(
        "the journal {} has version {theirs}, but this tankops reads version {ours}; use the tankops that wrote it",
        path.display()
    )]
    OtherVersion {
        /// Version of the journal.
        theirs: u32,
        /// Version that this tankops reads.
        ours: u32,
        /// The file.
        path: PathBuf,
    },
    /// A complete line is not a valid event.
    #[error("the journal is damaged at line {line}, column {column} ({why}): {}", path.display())]
    Damaged {
        /// The line, from 1.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// The fault of the line.
        why: String,
        /// The file.
        path: PathBuf,
    },
}
