//! Events to a rerun recording and to the journal, and back.
//!
//! The journal (`events.jsonl.zst`) is ours: every event, one line each, versioned, the same lines for the same run. The
//! recording (`recording.rrd`) is a view of it for the rerun viewer and can be regenerated from the journal at any
//! time. Both are written by one thread behind a bounded queue ([`RunRecorder`]). What cannot be written is kept in
//! memory up to a limit; a disk error, or a file that is deleted or changed by others, shows in [`Health`] within a
//! second, and the mission goes on.
//!
//! Nothing here prints: what the recording SDK has to say goes to `tracing`.

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
pub use marker::{FAILURE_FILE, recorded_failure, remove_reserve};
pub use recorder::{RECORDING_FILE, Recorder};
pub use sink::SinkHealth;
pub use thread::{Finished, Health, Options, RunRecorder};
