//! What can go wrong with runs on disk.

use recording::{JOURNAL_FILE, JournalError, RecordingError};
use std::{io, path::PathBuf};

/// Why a run cannot be kept, found or read.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The folder for runs takes none: why, and what to do.
    #[error("{0}")]
    Logs(String),
    /// The machine grants too little: which limit, and what to do.
    #[error("{0}")]
    Machine(String),
    /// There is no such run.
    #[error(
        "there is no run {}: neither a folder with {JOURNAL_FILE} nor the beginning of a name in {}, nor `latest`; `tankops runs` lists them",
        run.display(), logs.display()
    )]
    NoRun {
        /// What was asked for.
        run: PathBuf,
        /// The folder of runs.
        logs: PathBuf,
    },
    /// Several runs have names that begin so.
    #[error("the names of {count} runs begin with {begin}: {some}...; write more of the name")]
    ManyRuns {
        /// The beginning.
        begin: String,
        /// How many runs.
        count: usize,
        /// The first of them.
        some: String,
    },
    /// Its journal cannot be read.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// Journal and recording cannot be begun.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A name for its folder was not found.
    #[error("a thousand runs named {name} exist already: {}", logs.display())]
    NoName {
        /// The name that was tried, with numbers behind it.
        name: String,
        /// The folder of runs.
        logs: PathBuf,
    },
    /// A file beside a run is damaged.
    #[error("{} is damaged: {why}; put the file back as it was written", file.display())]
    Damaged {
        /// Which.
        file: PathBuf,
        /// What is wrong, with line and column.
        why: String,
    },
    /// What is asked for does not suit the run: why, and what to do.
    #[error("{0}")]
    Refused(String),
    /// The system refuses something else.
    #[error("{what}: {why}")]
    System {
        /// What was being done.
        what: String,
        /// What the system says.
        why: io::Error,
    },
}

impl RunError {
    /// Whether it is for the user to correct, and says how.
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

    /// What the system refuses while something is being done.
    pub(crate) fn during(what: String) -> impl FnOnce(io::Error) -> Self {
        |why| Self::System { what, why }
    }
}
