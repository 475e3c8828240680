//! A small file in the folder of a run that reports a failure of the journal or recording.
//!
//! If the process is killed later, or a report cannot be written, this file is the only sign of the failure. A full
//! disk has no space for a new file, so the space is reserved when the run starts, and the file is renamed when it is
//! needed.

use std::{
    fs::{self, File},
    io::{self, Read},
    os::unix::fs::FileExt,
    path::{Path, PathBuf},
};

/// Name of the file that marks the folder of a run whose journal or recording failed; its text states the reason.
pub const FAILURE_FILE: &str = "recording-failed.txt";
const RESERVE_FILE: &str = ".recording-failed.reserve";
/// Size of the file, bytes: one block on common file systems.
const LENGTH: usize = 4096;

/// The file of a run that is being written.
pub(crate) struct FailureMarker {
    file: File,
    reserve: PathBuf,
    marker: PathBuf,
    shown: Option<String>,
}

impl FailureMarker {
    /// Reserves the space for the file in the folder of a run.
    pub(crate) fn reserve(folder: &Path) -> io::Result<Self> {
        // The folder can still be found after a change of the working directory.
        let folder = std::path::absolute(folder)?;
        let (reserve, marker) = (folder.join(RESERVE_FILE), folder.join(FAILURE_FILE));
        let file = File::create_new(&reserve)?;
        file.write_all_at(&padded(""), 0)?;
        Ok(Self { file, reserve, marker, shown: None })
    }

    /// Shows the reason why recording fails or, with `None`, removes the report of a past failure.
    ///
    /// Errors are dropped: this is the last way to report anything, and a deleted folder accepts no message.
    pub(crate) fn show(&mut self, failure: Option<&str>) {
        if self.shown.as_deref() == failure {
            return;
        }
        let text = failure.unwrap_or_default();
        let _ = self.file.write_all_at(&padded(text), 0);
        let _ = match failure {
            Some(_) if self.shown.is_none() => fs::rename(&self.reserve, &self.marker),
            None => fs::rename(&self.marker, &self.reserve),
            Some(_) => Ok(()),
        };
        self.shown = failure.map(str::to_owned);
    }
}

impl Drop for FailureMarker {
    fn drop(&mut self) {
        // Removes only the reserve; a visible report remains for later readers of the run.
        let _ = fs::remove_file(&self.reserve);
    }
}

/// Removes the reserve of a writer that was killed, but not a file that reports a failure.
pub fn remove_reserve(folder: &Path) {
    let _ = fs::remove_file(folder.join(RESERVE_FILE));
}

/// Removes the file that reports a failure, once the files of the run have been made again from its journal.
pub fn remove_failure(folder: &Path) {
    let _ = fs::remove_file(folder.join(FAILURE_FILE));
}

/// The reason why the journal or recording of the run in a folder failed, if it did.
pub fn recorded_failure(folder: &Path) -> Option<String> {
    let mut text = Vec::new();
    // A longer file is not one of ours; reading its first part is enough.
    foreign::open_regular(&folder.join(FAILURE_FILE))
        .ok()?
        .take(LENGTH as u64)
        .read_to_end(&mut text)
        .ok()?;
    Some(String::from_utf8_lossy(&text).trim().to_owned())
}

/// A text padded to the length of the file, so that writing it never needs space.
fn padded(text: &str) -> Vec<u8> {
    let mut bytes: Vec<u8> = text.bytes().take(LENGTH - 1).collect();
    bytes.resize(LENGTH - 1, b' ');
    bytes.push(b'\n');
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("readable");
        entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn a_failure_is_shown_with_the_bytes_that_were_reserved() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut marker = FailureMarker::reserve(folder.path()).expect("room on the disk");
        assert_eq!(recorded_failure(folder.path()), None);
        marker.show(Some("the disk is full"));
        drop(marker);
        assert_eq!(recorded_failure(folder.path()).as_deref(), Some("the disk is full"));
        assert_eq!(names(folder.path()), [FAILURE_FILE]);
        let length = fs::metadata(folder.path().join(FAILURE_FILE)).expect("it is there").len();
        assert_eq!(length, LENGTH as u64);
    }

    #[test]
    fn a_failure_that_is_over_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut marker = FailureMarker::reserve(folder.path()).expect("room on the disk");
        marker.show(Some("the disk is full"));
        marker.show(None);
        assert_eq!(recorded_failure(folder.path()), None);
        drop(marker);
        assert!(names(folder.path()).is_empty());
    }
}
