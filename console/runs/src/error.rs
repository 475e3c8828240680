//! Errors of runs on disk.

use recording::{JOURNAL_FILE, JournalError, RecordingError};
use std::{io, path::PathBuf};

/// Whether an error of the system comes from the machine (a full or faulty disk), so that a different name would not help.
pub fn is_of_machine(error: &io::Error) -> bool {
    use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
    // EIO has no `ErrorKind`.
    matches!(error.kind(), StorageFull | QuotaExceeded | FileTooLarge) || error.raw_os_error() == Some(5)
}

/// The reason why a run cannot be kept, found or read.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// No run can be written to the folder for runs. Contains the reason, and what to do.
    #[error("{0}")]
    Logs(String),
    /// A limit set by the machine is too low. Contains the limit, and what to do.
    #[error("{0}")]
    Machine(String),
    /// The run does not exist.
    #[error(
        "there is no run {}: it is neither a folder with {JOURNAL_FILE}, nor the beginning of a name in {}, nor `latest`; `tankops runs` lists all runs",
        run.display(), logs.display()
    )]
    NoRun {
        /// The name or path that was given.
        run: PathBuf,
        /// The folder of runs.
        logs: PathBuf,
    },
    /// The names of several runs begin with the given text.
    #[error("the names of {count} runs begin with {begin}: {some}...; enter more of the name")]
    ManyRuns {
        /// The text that was given.
        begin: String,
        /// Number of matching runs.
        count: usize,
        /// The first of these runs.
        some: String,
    },
    /// The journal cannot be read.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The journal and the recording cannot be created.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// No free name was found for the folder of the run.
    #[error("a thousand runs named {name} already exist: {}", logs.display())]
    NoName {
        /// The name that was tried, with different numbers appended.
        name: String,
        /// The folder of runs.
        logs: PathBuf,
    },
    /// A file of the run other than its journal or recording is damaged.
    #[error("{} is damaged: {why}; restore the original file", file.display())]
    Damaged {
        /// Path of the file.
        file: PathBuf,
        /// The damage, with line and column.
        why: String,
    },
    /// The request does not suit the run. Contains the reason, and what to do.
    #[error("{0}")]
    Refused(String),
    /// Any other system error.
    #[error("{what}: {why}")]
    System {
        /// The operation that failed.
        what: String,
        /// The error reported by the system.
        why: io::Error,
    },
}

impl RunError {
    /// Whether the user can correct this; if so, the message tells how.
    pub fn is_input(&self) -> bool {
        matches!(
            self,
            Self::Logs(_)
                | Self::NoRun { .. }
                | Self::ManyRuns { .. }
                | Self::Damaged { .. }
                | Self::Refused(_)
                | Self::Journal(_)
        )
    }

    /// Wraps a system error together with the operation that failed.
    pub(crate) fn during(what: String) -> impl FnOnce(io::Error) -> Self {
        |why| Self::System { what, why }
    }
}
