//! The journal of a run: every event, one JSON object a line, in the order in which they happened; the lines are compressed.
//!
//! It carries no wall-clock time, so equal runs have equal lines, byte for byte. It is the record from which
//! everything else (recording, report, replay) can be made again, and it does not change with the recording SDK.

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
/// Its name where somebody has uncompressed it.
pub const PLAIN_JOURNAL_FILE: &str = "events.jsonl";

/// The journal in the folder of a run, compressed or not; where there is none, the path that it would have.
pub fn journal_of(folder: &Path) -> PathBuf {
    let (packed, plain) = (folder.join(JOURNAL_FILE), folder.join(PLAIN_JOURNAL_FILE));
    if !packed.exists() && plain.exists() { plain } else { packed }
}

/// Why a journal cannot be written or read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum JournalError {
    /// The file could not be made; a journal that exists already is never written over.
    #[error("cannot make the journal ({why}): {}", path.display())]
    Create {
        /// What the system says.
        why: String,
        /// Which file.
        path: PathBuf,
    },
    /// Writing failed; events are kept in memory and written when that is possible again.
    #[error(
        "the journal cannot be written beyond {bytes} bytes ({why}); events are kept in memory until it can"
    )]
    Stalled {
        /// How much was written.
        bytes: u64,
        /// What the system says.
        why: String,
    },
    /// Writing failed for good; what was written before it stays.
    #[error("the journal stopped after {bytes} bytes: {why}")]
    Write {
        /// How much was written.
        bytes: u64,
        /// What the system says.
        why: String,
    },
    /// The file on disk is not the one that was written.
    #[error("the journal is not on disk as it was written: {0}")]
    Changed(#[from] FileChange),
    /// The file could not be read.
    #[error("cannot read the journal ({why}): {}", path.display())]
    Read {
        /// What the system says.
        why: String,
        /// Which file.
        path: PathBuf,
    },
    /// The first line is not a `run_opened` event.
    #[error("this is not a journal: line 1 is not the event run_opened ({why}): {}", path.display())]
    NotAJournal {
        /// What is wrong with it.
        why: String,
        /// Which file.
        path: PathBuf,
    },
    /// It holds nothing, not even how the run was opened.
    #[error("the journal is empty or cut off before the opening of the run was written: {}", path.display())]
    NotOpened {
        /// Which file.
        path: PathBuf,
    },
    /// It was written by a tankops whose journals have another version.
    #[error(
        "the journal has version {theirs}, and this tankops reads version {ours}; use the tankops that wrote it: {}",
        path.display()
    )]
    OtherVersion {
        /// Version of the journal.
        theirs: u32,
        /// Version that this tankops reads.
        ours: u32,
        /// Which file.
        path: PathBuf,
    },
    /// A line that is complete cannot be understood.
    #[error("the journal is damaged at line {line}, column {column} ({why}): {}", path.display())]
    Damaged {
        /// Which line, from 1.
        line: usize,
        /// Which column, from 1.
        column: usize,
        /// What is wrong with it.
        why: String,
        /// Which file.
        path: PathBuf,
    },
}
