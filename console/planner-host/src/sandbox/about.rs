//! File status that a planner may receive. The console looks up the status itself, because the kernel would use a path
//! that may have changed since it was checked.

use std::fs::Metadata;
use std::mem::offset_of;
use std::os::unix::fs::MetadataExt;

/// The kernel's `stat` structure as bytes.
type Bytes = [u8; size_of::<libc::stat>()];

/// The file status that a call returns, and the address where the planner expects it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct About {
    pub(super) to: u64,
    pub(super) bytes: Bytes,
}

/// Returns the status of an open file of a thread.
///
/// # Errors
/// The system's error number. The same applies below.
pub(super) fn descriptor(thread: u32, number: i32) -> Result<Bytes, i32> {
    status(std::fs::metadata(format!("/proc/{thread}/fd/{number}")), libc::EBADF)
}

/// Returns the status of a file by its path.
pub(super) fn file(path: &str, flags: i32) -> Result<Bytes, i32> {
    let about = match flags & libc::AT_SYMLINK_NOFOLLOW {
        0 => std::fs::metadata(path),
        _ => std::fs::symlink_metadata(path),
    };
    status(about, libc::ENOENT)
}

fn status(about: std::io::Result<Metadata>, otherwise: i32) -> Result<Bytes, i32> {
    about.map(|about| bytes_of(&about)).map_err(|_| otherwise)
}

/// Writes the structure as the kernel does; missing fields are zero.
fn bytes_of(about: &Metadata) -> Bytes {
    macro_rules! place {
        ($field:ident) => {
            (offset_of!(libc::stat, $field), width(|stat: &libc::stat| &stat.$field))
        };
    }
    let mut bytes = [0; size_of::<libc::stat>()];
    for ((at, width), value) in [
        (place!(st_dev), about.dev()),
        (place!(st_ino), about.ino()),
        (place!(st_mode), about.mode().into()),
        (place!(st_nlink), about.nlink()),
        (place!(st_uid), about.uid().into()),
        (place!(st_gid), about.gid().into()),
        (place!(st_rdev), about.rdev()),
        (place!(st_size), about.size()),
        (place!(st_blksize), about.blksize()),
        (place!(st_blocks), about.blocks()),
        (place!(st_mtime), about.mtime().cast_unsigned()),
        (place!(st_mtime_nsec), about.mtime_nsec().cast_unsigned()),
        (place!(st_ctime), about.ctime().cast_unsigned()),
        (place!(st_ctime_nsec), about.ctime_nsec().cast_unsigned()),
    ] {
        let value = value.to_ne_bytes();
        let value = if cfg!(target_endian = "little") { &value[..width] } else { &value[8 - width..] };
        bytes[at..at + width].copy_from_slice(value);
    }
    bytes
}

fn width<F>(_: impl Fn(&libc::stat) -> &F) -> usize {
    size_of::<F>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_status_is_that_of_the_system() {
        let program = std::env::current_exe().expect("this program");
        let (status, known) = (
            file(&program.to_string_lossy(), 0).expect("status"),
            std::fs::metadata(program).expect("known"),
        );
        let at = |at: usize| u64::from_ne_bytes(status[at..at + 8].try_into().expect("eight bytes"));
        assert_eq!(at(offset_of!(libc::stat, st_size)), known.len());
        assert_eq!(at(offset_of!(libc::stat, st_ino)), known.ino());
        assert_eq!(file("/nonexistent", 0), Err(libc::ENOENT));
        assert_eq!(descriptor(std::process::id(), -1), Err(libc::EBADF));
    }
}
