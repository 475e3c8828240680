//! Ensures that the bytes that run are the bytes that were checked, by copying them to a place where they cannot be
//! changed while they are being loaded.

#[cfg(target_os = "linux")]
use crate::sandbox::PLUGIN_AT;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A private copy of the bytes, with a path for the loader.
pub(super) struct Staged {
    path: PathBuf,
    _place: Place,
}

enum Place {
    #[cfg(target_os = "linux")]
    Memory { _fd: std::os::fd::OwnedFd },
    #[cfg(any(test, not(target_os = "linux")))]
    Copy(PathBuf),
}

impl Staged {
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Keeps the copy until the process ends, because panic backtraces look up function names in it.
    pub(super) fn keep(self) {
        #[cfg(target_os = "linux")]
        std::mem::forget(self);
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        match self {
            #[cfg(target_os = "linux")]
            Self::Memory { .. } => {}
            #[cfg(any(test, not(target_os = "linux")))]
            Self::Copy(path) => {
                // By now the library has been loaded or refused; a leftover copy does no harm.
                let _ = std::fs::remove_file(path);
            }
        }
    }
}

/// Copies bytes to sealed memory, the only place that a sandboxed worker can reach.
#[cfg(target_os = "linux")]
pub(super) fn stage(bytes: &[u8]) -> io::Result<Staged> {
    seal(bytes)
}

/// Copies bytes to a private file.
#[cfg(not(target_os = "linux"))]
pub(super) fn stage(bytes: &[u8]) -> io::Result<Staged> {
    copy(bytes)
}

#[cfg(target_os = "linux")]
fn seal(bytes: &[u8]) -> io::Result<Staged> {
    use rustix::fs::{MemfdFlags, SealFlags, fcntl_add_seals, memfd_create};
    use std::os::fd::{AsRawFd, OwnedFd};

    let fd = memfd_create("planner", MemfdFlags::CLOEXEC | MemfdFlags::ALLOW_SEALING)?;
    let mut file = std::fs::File::from(fd);
    file.write_all(bytes)?;
    let seals = SealFlags::WRITE | SealFlags::SHRINK | SealFlags::GROW | SealFlags::SEAL;
    while_busy(|| fcntl_add_seals(&file, seals))?;
    let fd: OwnedFd = rustix::io::fcntl_dupfd_cloexec(&file, PLUGIN_AT)?;
    let path = PathBuf::from(format!("/proc/self/fd/{}", fd.as_raw_fd()));
    // Without /proc, the loader has no path to the copy.
    std::fs::metadata(&path)?;
    Ok(Staged { path, _place: Place::Memory { _fd: fd } })
}

/// Number of attempts to seal memory, and the pause between them.
#[cfg(target_os = "linux")]
const ATTEMPTS: usize = 200;
#[cfg(target_os = "linux")]
const PAUSE: std::time::Duration = std::time::Duration::from_millis(10);

/// Repeats an action while the system reports that memory is busy. The kernel refuses to seal pages that it is using
/// itself at that moment, for example while it moves them to other places on a machine with little free memory.
#[cfg(target_os = "linux")]
fn while_busy(mut action: impl FnMut() -> rustix::io::Result<()>) -> rustix::io::Result<()> {
    for _ in 1..ATTEMPTS {
        match action() {
            Err(rustix::io::Errno::BUSY) => std::thread::sleep(PAUSE),
            done => return done,
        }
    }
    action()
}

#[cfg(any(test, not(target_os = "linux")))]
fn copy(bytes: &[u8]) -> io::Result<Staged> {
    use std::os::unix::fs::OpenOptionsExt;

    let path = std::env::temp_dir().join(format!("tankops-planner-{}.so", std::process::id()));
    let mut file = std::fs::OpenOptions::new().write(true).create_new(true).mode(0o700).open(&path)?;
    let place = Place::Copy(path.clone());
    file.write_all(bytes)?;
    Ok(Staged { path, _place: place })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn staged_bytes_are_the_bytes_and_a_copy_goes_away() {
        let staged = stage(b"content").expect("staged");
        assert_eq!(std::fs::read(staged.path()).expect("readable"), b"content");
        let copied = copy(b"content").expect("copied");
        let path = copied.path().to_owned();
        assert_eq!(std::fs::read(&path).expect("readable"), b"content");
        drop(copied);
        assert!(!path.exists());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn memory_that_is_busy_is_sealed_as_soon_as_it_is_free() {
        use rustix::io::Errno;

        let mut answers = vec![Ok(()), Err(Errno::BUSY), Err(Errno::BUSY)];
        assert_eq!(while_busy(|| answers.pop().expect("no further attempt")), Ok(()));
        let mut attempts = 0;
        let never = while_busy(|| {
            attempts += 1;
            Err(Errno::INVAL)
        });
        assert_eq!((never, attempts), (Err(Errno::INVAL), 1), "other errors are final");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn sealed_bytes_cannot_be_changed() {
        let staged = seal(b"content").expect("sealed");
        let written =
            std::fs::OpenOptions::new().write(true).open(staged.path()).and_then(|mut f| f.write_all(b"x"));
        assert!(written.is_err());
    }
}
