//! The files of a run: reading, hashing, and checking that the path of an open file still leads to it.
//!
//! A file that is deleted, replaced or truncated while it is open accepts every further write without an error. Only
//! a comparison with the file at the path detects this.

use foreign::open_regular;
use sha2::{Digest, Sha256};
use std::{
    fs::{self, File, OpenOptions},
    io::{self, Read},
    os::unix::fs::MetadataExt,
    path::{Path, PathBuf},
};

/// SHA-256 of a file, hexadecimal.
///
/// # Errors
/// The file is not a regular file, or cannot be read.
pub fn sha256(path: &Path) -> io::Result<String> {
    sha256_while(path, |_| true)
}

/// Like [`sha256`], but stops as soon as `goes_on` returns `false`; `goes_on` receives the number of bytes read.
///
/// # Errors
/// Those of [`sha256`], and [`io::ErrorKind::Interrupted`] if it was stopped.
pub fn sha256_while(path: &Path, goes_on: impl FnMut(u64) -> bool) -> io::Result<String> {
    digest(&mut open_regular(path)?, goes_on)
}

/// SHA-256 of all bytes of a reader, hexadecimal.
pub(crate) fn digest(from: &mut dyn Read, mut goes_on: impl FnMut(u64) -> bool) -> io::Result<String> {
    let (mut hasher, mut chunk, mut bytes) = (Sha256::new(), vec![0; 1 << 18], 0);
    while goes_on(bytes) {
        match from.read(&mut chunk)? {
            0 => return Ok(hex::encode(hasher.finalize())),
            length => {
                hasher.update(&chunk[..length]);
                bytes += length as u64;
            }
        }
    }
    Err(io::Error::new(io::ErrorKind::Interrupted, "stopped"))
}

/// SHA-256 of a byte slice, hexadecimal.
pub fn sha256_of(bytes: &[u8]) -> String {
    hex::encode(Sha256::digest(bytes))
}

/// The difference between a file on disk and the file that was opened and written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FileChange {
    /// The file was deleted or moved from its path.
    #[error("the file was deleted or moved: {}", path.display())]
    Deleted {
        /// The file.
        path: PathBuf,
    },
    /// The path leads to a different file.
    #[error("the file was replaced by a different one: {}", path.display())]
    Replaced {
        /// The file.
        path: PathBuf,
    },
    /// The length of the file differs from the number of bytes written to it.
    #[error("the file has {found} bytes, but {written} were written: {}", path.display())]
    Length {
        /// Length on disk, bytes.
        found: u64,
        /// Number of bytes written.
        written: u64,
        /// The file.
        path: PathBuf,
    },
    /// The file has the expected length, but different content.
    #[error("the file was changed by another program: {}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
    },
    /// The system cannot examine the file.
    #[error("the file cannot be examined ({why}): {}", path.display())]
    Unknown {
        /// The error of the system.
        why: String,
        /// The file.
        path: PathBuf,
    },
}

/// The identity of an open file, for comparison with the file at its path.
///
/// The system does not reuse the inode while this file is open.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct FileWatch {
    path: PathBuf,
    device: u64,
    inode: u64,
}

impl FileWatch {
    /// Creates a file; fails if it exists.
    ///
    /// Every write goes to the end of the file, so a file that another program truncates stays shorter than the data
    /// written to it.
    pub(crate) fn create(path: &Path) -> io::Result<(File, Self)> {
        let file = OpenOptions::new().append(true).create_new(true).open(path)?;
        let opened = file.metadata()?;
        // The working directory may change, but the file stays where it is.
        let path = std::path::absolute(path)?;
        Ok((file, Self { path, device: opened.dev(), inode: opened.ino() }))
    }

    /// The absolute path of the file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Checks that the file at the path is this one and has at least this length; more bytes may still be on their
    /// way.
    pub(crate) fn check(&self, written: u64) -> Result<(), FileChange> {
        self.check_length(written, |found| found >= written)
    }

    /// Checks that the file at the path is this one and has exactly this length.
    pub(crate) fn check_closed(&self, written: u64) -> Result<(), FileChange> {
        self.check_length(written, |found| found == written)
    }

    /// Checks that the file at the path is this one and has exactly this length and hash.
    pub(crate) fn check_content(&self, written: u64, expected: &str) -> Result<(), FileChange> {
        self.check_closed(written)?;
        let path = || self.path.clone();
        match sha256(&self.path) {
            Ok(found) if found == expected => Ok(()),
            Ok(_) => Err(FileChange::Content { path: path() }),
            Err(error) => Err(FileChange::Unknown { why: error.to_string(), path: path() }),
        }
    }

    fn check_length(&self, written: u64, fits: impl Fn(u64) -> bool) -> Result<(), FileChange> {
        let path = || self.path.clone();
        let shown = fs::metadata(&self.path).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => FileChange::Deleted { path: path() },
            _ => FileChange::Unknown { why: error.to_string(), path: path() },
        })?;
        if (shown.dev(), shown.ino()) != (self.device, self.inode) {
            return Err(FileChange::Replaced { path: path() });
        }
        let found = shown.len();
        if fits(found) { Ok(()) } else { Err(FileChange::Length { found, written, path: path() }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn written() -> (tempfile::TempDir, PathBuf, File, FileWatch) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("file");
        let (mut file, watch) = FileWatch::create(&path).expect("a new file");
        file.write_all(b"12345678").expect("room on the disk");
        (folder, path, file, watch)
    }

    #[test]
    fn an_untouched_file_is_the_one_that_was_opened() {
        let (_folder, path, _file, watch) = written();
        assert_eq!(watch.check(8), Ok(()));
        assert_eq!(watch.check(7), Ok(()), "more may be on its way");
        assert_eq!(watch.check_closed(8), Ok(()));
        assert_eq!(watch.check_closed(7), Err(FileChange::Length { found: 8, written: 7, path }));
    }

    #[test]
    fn a_file_that_was_deleted_or_replaced_is_noticed() {
        let (_folder, path, _file, watch) = written();
        fs::remove_file(&path).expect("ours");
        assert_eq!(watch.check(8), Err(FileChange::Deleted { path: path.clone() }));
        fs::write(&path, "12345678").expect("writable");
        assert_eq!(watch.check(8), Err(FileChange::Replaced { path }));
    }

    #[test]
    fn a_file_of_the_same_length_and_other_content_is_noticed() {
        let (_folder, path, _file, watch) = written();
        let expected = sha256(&path).expect("readable");
        assert_eq!(watch.check_content(8, &expected), Ok(()));
        fs::write(&path, "1234x678").expect("ours");
        assert_eq!(watch.check_content(8, &expected), Err(FileChange::Content { path }));
    }

    #[test]
    fn a_truncated_file_stays_too_short_whatever_is_written_next() {
        let (_folder, path, mut file, watch) = written();
        OpenOptions::new().write(true).truncate(true).open(&path).expect("ours");
        file.write_all(b"9abc").expect("room on the disk");
        assert_eq!(watch.check(12), Err(FileChange::Length { found: 4, written: 12, path }));
    }
}
