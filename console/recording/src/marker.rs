//! A small file in the folder of a run that says that journal or recording failed.
//!
//! A process that is killed later, or a report that cannot be written, leaves no other sign of it. The file's space is
//! taken when the run starts and the file is renamed when it is needed, because a full disk has no room for a new one.

use std::{
    fs::{self, File},
    io::{self, Read},
    os::unix::fs::FileExt,
    path::{Path, PathBuf},
};

/// Name of the file in the folder of a run whose journal or recording failed; its text says why.
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
    /// Takes the space for the file in the folder of a run.
    pub(crate) fn reserve(folder: &Path) -> io::Result<Self> {
        // The folder is found again if the working directory changes.
        let folder = std::path::absolute(folder)?;
        let (reserve, marker) = (folder.join(RESERVE_FILE), folder.join(FAILURE_FILE));
        let file = File::create_new(&reserve)?;
        file.write_all_at(&padded(""), 0)?;
        Ok(Self { file, reserve, marker, shown: None })
    }

    /// Shows why recording fails, or, with `None`, that it does not any more.
    ///
    /// Errors are dropped: this is the last thing that can be said, and a folder that is gone takes no message.
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
        // Only the reserve: what is shown stays for those who look at the run later.
        let _ = fs::remove_file(&self.reserve);
    }
}

/// Removes what a writer that was killed had taken for the file; not a file that says why something failed.
pub fn remove_reserve(folder: &Path) {
    let _ = fs::remove_file(folder.join(RESERVE_FILE));
}

/// Why journal or recording of the run in a folder failed, if they did.
pub fn recorded_failure(folder: &Path) -> Option<String> {
    let mut text = Vec::new();
    // What is longer is not ours, and its beginning says enough.
    foreign::open_regular(&folder.join(FAILURE_FILE))
        .ok()?
        .take(LENGTH as u64)
        .read_to_end(&mut text)
        .ok()?;
    Some(String::from_utf8_lossy(&text).trim().to_owned())
}

/// A text of the file's length, whatever it says, so that writing it never needs space.
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
