//! Writes events to a rerun recording and to the journal, and reads them back.
//!
//! The journal (`events.jsonl.zst`) has our own format: every event on a line of its own, versioned, with the same
//! lines for the same run. The recording (`recording.rrd`) is a view of the journal for the rerun viewer and can be
//! regenerated from it at any time. One thread behind a bounded queue writes both ([`RunRecorder`]). Data that cannot
//! be written is kept in memory up to a limit. A disk error, or the deletion or change of a file by another program,
//! appears in [`Health`] within a second, and the mission continues.
//!
//! This crate prints nothing: messages of the recording SDK go to `tracing`.

pub mod ahead;
mod backlog;
pub mod error;
pub mod export;
pub mod file;
pub mod identity;
pub mod inspect;
pub mod journal;
pub mod marker;
pub mod mcap;
mod merge;
mod readings;
pub mod recorder;
mod rr;
mod sink;
pub mod thread;

pub use self::mcap::export_mcap;
pub use error::RecordingError;
pub use export::export;
pub use file::{FileChange, sha256, sha256_of, sha256_while};
pub use identity::Identity;
pub use inspect::{Summary, inspect};
pub use journal::{
    Difference, JOURNAL_FILE, JournalEnd, JournalError, JournalLine, JournalPlace, JournalReader,
    JournalWriter, PLAIN_JOURNAL_FILE, RecordedTick, Ticks, events_sha256, events_sha256_while, journal_of,
    read_ending,
};
pub use marker::{FAILURE_FILE, recorded_failure, remove_failure, remove_reserve};
pub use readings::{READINGS_FILE, ReadingsWriter, each_reading, export_readings};
pub use recorder::{RECORDING_FILE, Recorder};
pub use sink::SinkHealth;
pub use thread::{Finished, Health, Options, RunRecorder};
