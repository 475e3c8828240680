//! A folder in which several processes on several machines work at the same time. Files are complete or absent, and
//! claims record which process works on what.

use anyhow::Context;
use foreign::{open_regular, read_regular};
use runs::write_by_draft;
use rustix::fs::{Timespec, Timestamps, UTIME_NOW, futimens};
use std::{
    fs::{self, File},
    io::{self, Read, Write},
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

/// Time without a refresh after which a claim is void; also the age from which a draft counts as abandoned.
const SILENT_FOR: Duration = Duration::from_mins(10);
/// The subfolder of the claims.
const CLAIMS: &str = "claims";

/// A folder that several processes share.
#[derive(Debug, Clone)]
pub struct SharedFolder(PathBuf);

impl SharedFolder {
    /// Creates a handle to the folder at a path.
    pub fn new(path: &Path) -> Self {
        Self(path.to_owned())
    }

    /// The path of the folder.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Creates the folder, these subfolders and the subfolder for claims, unless they exist.
    ///
    /// # Errors
    /// A folder cannot be created.
    pub fn make(&self, inner: &[&str]) -> anyhow::Result<()> {
        for folder in inner.iter().chain([&CLAIMS]).map(|inner| self.0.join(inner)) {
            fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
        }
        Ok(())
    }

    /// Whether the folder contains a file or a subfolder of this name.
    pub fn has(&self, name: &Path) -> bool {
        self.0.join(name).exists()
    }

    /// Reads a regular file; returns `None` if it does not exist.
    ///
    /// # Errors
    /// The file cannot be read, or is not a regular file.
    pub fn read(&self, name: &Path) -> io::Result<Option<Vec<u8>>> {
        let mut bytes = Vec::new();
        match open_regular(&self.0.join(name)).and_then(|mut file| file.read_to_end(&mut bytes)) {
            Ok(_) => Ok(Some(bytes)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Writes a file completely or not at all: writes a draft, syncs it to disk, then renames it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn publish(&self, name: &Path, bytes: &[u8]) -> anyhow::Result<()> {
        let file = self.0.join(name);
        let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default().as_nanos();
        let draft = file.with_extension(format!("draft-{}-{now}", std::process::id()));
        write_by_draft(&file, &draft, bytes).with_context(|| format!("writing {}", file.display()))
    }

    /// Removes the drafts of killed processes from these subfolders; drafts that are being written stay.
    pub fn tidy(&self, inner: &[&str]) {
        let now = self.now();
        for folder in inner.iter().map(|inner| self.0.join(inner)) {
            let files = fs::read_dir(folder).into_iter().flatten().flatten();
            let is_draft = |file: &PathBuf| {
                file.extension().is_some_and(|extension| extension.to_string_lossy().starts_with("draft-"))
            };
            // A draft that cannot be removed does no harm.
            let left = files.map(|file| file.path()).filter(|file| is_draft(file) && is_silent(file, now));
            left.for_each(|file| drop(fs::remove_file(file)));
        }
    }

    /// The time according to the clock that dates the files in this folder. If the folder is on a server, this is the
    /// server's clock, so all machines judge claims alike even if their own clocks are wrong.
    fn now(&self) -> SystemTime {
        let probe = self.0.join(CLAIMS).join(format!(".now-{}-{}", host(), std::process::id()));
        let dated = File::create(&probe).and_then(|mut file| {
            file.write_all(b".")?;
            file.metadata()?.modified()
        });
        let _ = fs::remove_file(&probe);
        dated.unwrap_or_else(|_| SystemTime::now())
    }

    /// The path of a claim file; the file contains the machine name and the process id.
    pub fn claim_file(&self, name: &str) -> PathBuf {
        self.0.join(CLAIMS).join(name)
    }

    /// Claims an item for this process; returns `false` if another process holds the item.
    pub fn claim(&self, name: &str) -> bool {
        let claim = self.claim_file(name);
        if claim.exists() && is_void(&claim, self.now()) {
            // If two processes find the claim void at the same time, both do the same work at worst.
            let _ = fs::remove_file(&claim);
        }
        match File::create_new(&claim) {
            // If the holder cannot be written to the claim, the claim becomes void with age.
            Ok(mut made) => drop(write!(made, "{} {}", host(), std::process::id())),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => return false,
            // No claim can be created here, and waiting would never end. Publishing the results will report the
            // problem.
            Err(_) => {}
        }
        true
    }

    /// Refreshes a claim, so that other processes see that its holder is alive.
    pub fn keep_claim(&self, name: &str) {
        let now = Timespec { tv_sec: 0, tv_nsec: UTIME_NOW };
        let touched = File::options().write(true).open(self.claim_file(name));
        // If this fails, at worst the work is done twice.
        drop(touched.map(|claim| futimens(claim, &Timestamps { last_access: now, last_modification: now })));
    }

    /// Releases a claim.
    pub fn release(&self, name: &str) {
        // A claim that cannot be removed becomes void later.
        let _ = fs::remove_file(self.claim_file(name));
    }
}

/// Whether the holder of a claim is gone: the claim was not refreshed for too long, or its process on this machine has
/// ended.
fn is_void(claim: &Path, now: SystemTime) -> bool {
    if is_silent(claim, now) {
        return true;
    }
    let holder = read_regular(claim).unwrap_or_default();
    let here = format!("{} ", host());
    let process = holder.strip_prefix(&here).and_then(|process| process.trim().parse::<u32>().ok());
    let processes = Path::new("/proc");
    processes.join("self").exists()
        && process.is_some_and(|process| !processes.join(process.to_string()).exists())
}

/// Whether a file has not been modified for so long that the process that wrote it must have stopped.
fn is_silent(file: &Path, now: SystemTime) -> bool {
    let touched = fs::metadata(file).and_then(|file| file.modified());
    touched.is_ok_and(|at| now.duration_since(at).unwrap_or_default() > SILENT_FOR)
}

/// The name of this machine. If two machines have the same name, at worst both do the same work.
fn host() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    name.split_whitespace().next().unwrap_or("?").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes a file look as if it had not been modified for a long time.
    fn age(file: &Path) {
        let file = File::options().write(true).open(file).expect("a file");
        file.set_modified(SystemTime::now() - SILENT_FOR - Duration::from_secs(1)).expect("set");
    }

    #[test]
    fn a_claim_is_taken_once_and_void_when_its_holder_is_silent() {
        let here = tempfile::tempdir().expect("a folder");
        let folder = SharedFolder::new(here.path());
        folder.make(&[]).expect("a folder");
        assert!(folder.claim("3") && !folder.claim("3") && folder.claim("4"));
        age(&here.path().join("claims/3"));
        assert!(folder.claim("3") && !folder.claim("3"));
        folder.release("3");
        assert!(folder.claim("3"));
    }

    #[test]
    fn a_claim_of_a_process_that_has_ended_is_void_at_once() {
        let here = tempfile::tempdir().expect("a folder");
        let folder = SharedFolder::new(here.path());
        folder.make(&[]).expect("a folder");
        let mut ended = std::process::Command::new("true").spawn().expect("a process");
        ended.wait().expect("it ends");
        let claim = here.path().join("claims/3");
        fs::write(&claim, format!("{} {}", host(), ended.id())).expect("written");
        assert!(folder.claim("3"));
        fs::write(&claim, format!("another-machine {}", ended.id())).expect("written");
        assert!(!folder.claim("3"), "nobody here knows");
    }

    #[test]
    fn a_claim_is_as_old_as_the_file_system_says_and_a_holder_that_speaks_keeps_it() {
        let here = tempfile::tempdir().expect("a folder");
        let folder = SharedFolder::new(here.path());
        folder.make(&[]).expect("a folder");
        assert!(folder.claim("3"));
        let claim = here.path().join("claims/3");
        fs::write(&claim, "another-machine 1").expect("written");
        let dated = |file: &Path| fs::metadata(file).and_then(|file| file.modified()).expect("dated");
        let apart = dated(&claim).duration_since(folder.now()).unwrap_or_else(|late| late.duration());
        assert!(apart < SILENT_FOR);
        age(&claim);
        folder.keep_claim("3");
        assert!(!folder.claim("3"));
        let left: Vec<_> = fs::read_dir(here.path().join("claims")).expect("read").flatten().collect();
        assert_eq!(left.len(), 1, "the probe is gone: {left:?}");
    }

    #[test]
    fn where_nothing_can_be_claimed_nobody_waits() {
        let here = tempfile::tempdir().expect("a folder");
        let folder = SharedFolder::new(here.path());
        fs::write(here.path().join("claims"), "not a folder").expect("written");
        assert!(folder.claim("3") && folder.claim("3"));
    }

    #[test]
    fn a_file_is_published_whole_and_drafts_that_were_left_are_tidied() {
        let here = tempfile::tempdir().expect("a folder");
        let folder = SharedFolder::new(here.path());
        folder.publish(Path::new("a.json"), b"{}").expect("written");
        let draft = here.path().join("a.draft-1-2");
        fs::write(&draft, "half").expect("written");
        let names = || {
            folder.tidy(&["."]);
            let files = fs::read_dir(here.path()).expect("read").flatten();
            files.map(|file| file.file_name()).collect::<std::collections::BTreeSet<_>>()
        };
        assert_eq!(names().len(), 2, "somebody may be writing it");
        age(&draft);
        assert_eq!(names().into_iter().collect::<Vec<_>>(), ["a.json"]);
    }
}
