//! Errors of a recording.

use crate::{file::FileChange, journal::JournalError};
use std::path::PathBuf;

/// The reason why a recording is missing or stopped.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file could not be created.
    #[error("cannot create the file ({why}): {}", path.display())]
    Create {
        /// The error of the system.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// The file could not be read.
    #[error("cannot read the recording ({why}): {}", path.display())]
    Read {
        /// The error of the system or the format.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// The recording SDK panics if the clock is before 1970.
    #[error("the clock of this machine is before 1970, which the recording SDK cannot handle: set the clock")]
    Clock,
    /// The first event is not `run_opened`, so there is no world to draw.
    #[error("a recording must begin with the event run_opened, but {got} came first")]
    NotOpened {
        /// The event that came first.
        got: String,
    },
    /// Writing failed; data is kept in memory until it can be written.
    #[error("the recording cannot be written ({why}); its data is kept in memory until writing succeeds")]
    Stalled {
        /// The error of the system.
        why: String,
    },
    /// Writing failed for good; the file contains everything up to the failure.
    #[error("the recording stopped: {why}")]
    Write {
        /// The error of the system.
        why: String,
    },
    /// A file that a journal gives could not be written.
    #[error("cannot write the file ({why}): {}", path.display())]
    File {
        /// The error of the system or the format.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// The chunks of a recording cannot be merged; the recording is complete even so.
    #[error("the chunks of the recording cannot be merged ({why}): {}", path.display())]
    Merge {
        /// The error of the system or the format.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// The file on disk is not the file that was written.
    #[error("the recording on disk differs from what was written: {0}")]
    Changed(#[from] FileChange),
    /// The readings cannot be written; the journal is complete even so.
    #[error(
        "the readings cannot be written ({why}); if they are simulated, `tankops export --readings` makes them from the \
         journal: {}",
        path.display()
    )]
    Readings {
        /// The error of the system or the format.
        why: String,
        /// The file.
        path: PathBuf,
    },
    /// The run has no readings.
    #[error("this run has no readings: its scenario has no [instrument] with channels, or no [wear]")]
    NoReadings,
    /// The recording SDK refused data.
    #[error("the recording stopped: the recording SDK refused data ({why})")]
    Sdk {
        /// The message of the SDK.
        why: String,
    },
    /// The journal failed.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The file for a failure report could not be created.
    #[error("cannot reserve space for a failure report ({why}): {}", folder.display())]
    Marker {
        /// The error of the system.
        why: String,
        /// The folder of the run.
        folder: PathBuf,
    },
    /// The recorder's thread could not be started.
    #[error("cannot start the recorder's thread: {why}")]
    Thread {
        /// The error of the system.
        why: String,
    },
}

impl RecordingError {
    /// Converts an error of the recording SDK.
    pub(crate) fn sdk(error: &impl std::fmt::Display) -> Self {
        Self::Sdk { why: error.to_string() }
    }
}
