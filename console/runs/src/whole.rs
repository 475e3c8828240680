//! Writes files atomically: either the complete file is written, or nothing is.

use rustix::fs::OFlags;
use std::{
    fs::{self, File, Metadata, OpenOptions},
    io::{self, Write},
    os::unix::fs::{MetadataExt, OpenOptionsExt},
    path::{Path, PathBuf},
};

/// Writes a file atomically: first to a draft beside it, `NAME.part`, which is flushed to disk and then renamed. If a
/// draft already exists, the space that it occupies is reused. If writing fails, the file is unchanged and no draft
/// remains.
///
/// A target that is not a regular file (a pipe, `/dev/stdout`) is written to directly.
///
/// # Errors
/// The system refuses to write the file, or the file is read-only.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    // A link stays a link: its target is replaced.
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let there = path.metadata().ok();
    if there.as_ref().is_some_and(|file| !file.is_file()) {
        return fs::write(&path, bytes);
    }
    if there.is_some_and(|file| file.permissions().readonly()) {
        // The system would allow the file to be replaced, and root could write to it anyway.
        return Err(io::Error::new(
            io::ErrorKind::PermissionDenied,
            "the file is read-only, as signed reports are",
        ));
    }
    write_by_draft(&path, &draft_of(&path), bytes)
}

/// Like [`write_whole`], for a file that is too long for the memory, or that is not written from its begin to its end:
/// `write` fills an empty draft.
///
/// # Errors
/// Those of `write`; the system refuses to write the file; or there is a file of another kind, or a read-only one.
pub fn write_whole_with<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut File) -> Result<(), E>,
) -> Result<(), E> {
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if path.metadata().is_ok_and(|file| !file.is_file() || file.permissions().readonly()) {
        let why = "there is a read-only file, a pipe or a device with this name";
        return Err(io::Error::new(io::ErrorKind::PermissionDenied, why).into());
    }
    let draft = draft_of(&path);
    let fill = || {
        let mut file = open_draft(&draft)?;
        file.set_len(0)?;
        write(&mut file)?;
        file.sync_all()?;
        Ok(fs::rename(&draft, &path)?)
    };
    fill().inspect_err(|_: &E| drop(fs::remove_file(&draft)))?;
    let _ = path.parent().map(|folder| File::open(folder).and_then(|folder| folder.sync_all()));
    Ok(())
}

/// Like [`write_whole`], with a different name for the draft, for files that several processes may write at the same
/// time.
///
/// # Errors
/// The system refuses to write the file.
pub fn write_by_draft(path: &Path, draft: &Path, bytes: &[u8]) -> io::Result<()> {
    write_in(path, draft, bytes, || open_draft(draft))
}

/// Opens an existing draft of ours, or replaces anything else that has its name: a link or a pipe would send the data
/// elsewhere.
fn open_draft(draft: &Path) -> io::Result<File> {
    let flags = OFlags::NOFOLLOW | OFlags::NONBLOCK;
    let there = OpenOptions::new().write(true).custom_flags(flags.bits().cast_signed()).open(draft);
    let is_ours = |about: &Metadata| about.is_file() && about.nlink() == 1;
    if let Some(file) = there.ok().filter(|file| file.metadata().is_ok_and(|about| is_ours(&about))) {
        return Ok(file);
    }
    match fs::remove_file(draft) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => File::create_new(draft),
    }
}

/// Path of the draft of a file: `NAME.part`.
pub(crate) fn draft_of(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    path.with_file_name(name)
}

/// The file to write to.
trait Draft: Write {
    /// Truncates the file.
    fn cut(&mut self, bytes: u64) -> io::Result<()>;
    /// Flushes the file to disk.
    fn settle(&mut self) -> io::Result<()>;
}

impl Draft for File {
    fn cut(&mut self, bytes: u64) -> io::Result<()> {
        self.set_len(bytes)
    }

    fn settle(&mut self) -> io::Result<()> {
        self.sync_all()
    }
}

fn write_in<D: Draft>(
    path: &Path,
    draft: &Path,
    bytes: &[u8],
    open: impl FnOnce() -> io::Result<D>,
) -> io::Result<()> {
    let write = || {
        let mut file = open()?;
        file.write_all(bytes)?;
        file.cut(bytes.len() as u64)?;
        file.settle()?;
        fs::rename(draft, path)
    };
    write().inspect_err(|_| drop(fs::remove_file(draft)))?;
    // The new name is stored in the folder; some file systems cannot flush a folder.
    let _ = path.parent().map(|folder| File::open(folder).and_then(|folder| folder.sync_all()));
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    /// A file whose call number `fails_at` fails; it takes a few bytes at a time.
    struct FaultyFile {
        file: File,
        calls: usize,
        fails_at: usize,
    }

    impl FaultyFile {
        fn fault(&mut self) -> io::Result<()> {
            self.calls += 1;
            if self.calls == self.fails_at { Err(io::ErrorKind::StorageFull.into()) } else { Ok(()) }
        }
    }

    impl Write for FaultyFile {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.fault()?;
            self.file.write(&bytes[..bytes.len().min(7)])
        }

        fn flush(&mut self) -> io::Result<()> {
            self.fault()
        }
    }

    impl Draft for FaultyFile {
        fn cut(&mut self, bytes: u64) -> io::Result<()> {
            self.fault()?;
            self.file.cut(bytes)
        }

        fn settle(&mut self) -> io::Result<()> {
            self.fault()
        }
    }

    #[test]
    fn whichever_call_fails_the_file_before_stays_whole() {
        let folder = tempfile::tempdir().unwrap();
        let (path, new) = (folder.path().join("report.json"), b"the new report".repeat(9));
        let draft = draft_of(&path);
        let mut fails_at = 0;
        loop {
            fails_at += 1;
            fs::write(&path, "the old report").unwrap();
            fs::write(&draft, vec![b'\n'; 4096]).unwrap();
            let open =
                || Ok(FaultyFile { file: OpenOptions::new().write(true).open(&draft)?, calls: 0, fails_at });
            let written = write_in(&path, &draft, &new, open);
            assert!(!draft.exists(), "call {fails_at}");
            if written.is_ok() {
                break;
            }
            assert_eq!(fs::read(&path).unwrap(), b"the old report", "call {fails_at}");
        }
        assert_eq!(fs::read(&path).unwrap(), new);
        assert_eq!(fails_at, new.len().div_ceil(7) + 2 + 1, "every call failed once");
    }

    #[test]
    fn a_link_stays_a_link_and_what_is_no_file_is_written_to() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write_whole(&link, b"new").unwrap();
        assert!(link.symlink_metadata().unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
        write_whole(Path::new("/dev/null"), b"new").unwrap();
        assert!(!Path::new("/dev/null").metadata().unwrap().is_file());
        assert!(write_whole(folder.path(), b"new").is_err(), "a folder");
        let mut sealed = fs::metadata(&file).unwrap().permissions();
        sealed.set_readonly(true);
        fs::set_permissions(&file, sealed).unwrap();
        for path in [&file, &link] {
            let refused = write_whole(path, b"newer").unwrap_err().to_string();
            assert!(refused.contains("read-only"), "{refused}");
        }
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn a_draft_that_leads_elsewhere_is_not_written_to() {
        let folder = tempfile::tempdir().unwrap();
        let [file, draft, victim] = ["file", "file.part", "victim"].map(|name| folder.path().join(name));
        fs::write(&victim, "precious").unwrap();
        let links: [fn(&Path, &Path) -> io::Result<()>; 2] =
            [|to, at| std::os::unix::fs::symlink(to, at), |to, at| fs::hard_link(to, at)];
        for link in links {
            link(&victim, &draft).unwrap();
            write_whole(&file, b"new").unwrap();
            assert_eq!(
                (fs::read(&file).unwrap(), fs::read(&victim).unwrap()),
                (b"new".to_vec(), b"precious".to_vec())
            );
        }
        assert!(std::process::Command::new("mkfifo").arg(&draft).status().unwrap().success());
        write_whole(&file, b"newer").unwrap();
        assert_eq!((fs::read(&file).unwrap(), draft.exists()), (b"newer".to_vec(), false));
    }
}
