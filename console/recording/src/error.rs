//! What can go wrong with a recording.

use crate::{file::FileChange, journal::JournalError};
use std::path::PathBuf;

/// Why there is no recording, or why it stopped.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file could not be made.
    #[error("cannot create the file ({why}): {}", path.display())]
    Create {
        /// What the system says.
        why: String,
        /// Which file.
        path: PathBuf,
    },
    /// The file could not be read.
    #[error("cannot read the recording ({why}): {}", path.display())]
    Read {
        /// What the system or the format says.
        why: String,
        /// Which file.
        path: PathBuf,
    },
    /// The recording SDK panics where the clock is before its first moment.
    #[error("the clock of this machine is before 1970, and a recording cannot be: set the clock")]
    Clock,
    /// The first event is not `run_opened`, so there is no world to draw.
    #[error("a recording begins with the event run_opened, got {got} first")]
    NotOpened {
        /// Which event came first.
        got: String,
    },
    /// Writing failed; data is kept in memory and written when that is possible again.
    #[error("the recording cannot be written ({why}); its data is kept in memory until it can")]
    Stalled {
        /// What the system says.
        why: String,
    },
    /// Writing failed for good; everything before it is in the file.
    #[error("the recording stopped: {why}")]
    Write {
        /// What the system says.
        why: String,
    },
    /// The chunks of a recording cannot be merged; it is whole without that.
    #[error("the chunks of the recording cannot be merged ({why}): {}", path.display())]
    Merge {
        /// What the system or the format says.
        why: String,
        /// Which file.
        path: PathBuf,
    },
    /// The file on disk is not the one that was written.
    #[error("the recording is not on disk as it was written: {0}")]
    Changed(#[from] FileChange),
    /// The recording SDK refused something.
    #[error("the recording stopped: the recording SDK refused data ({why})")]
    Sdk {
        /// What it says.
        why: String,
    },
    /// The journal failed.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The file that would report a failure could not be made.
    #[error("cannot reserve space for the report of a failure ({why}): {}", folder.display())]
    Marker {
        /// What the system says.
        why: String,
        /// Which folder of a run.
        folder: PathBuf,
    },
    /// The recorder's thread could not be started.
    #[error("cannot start the recorder's thread: {why}")]
    Thread {
        /// What the system says.
        why: String,
    },
}

impl RecordingError {
    /// An error of the recording SDK.
    pub(crate) fn sdk(error: &impl std::fmt::Display) -> Self {
        Self::Sdk { why: error.to_string() }
    }
}
