//! A folder in which several processes work at once, on several machines: files that are there whole or not at all, and
//! claims that say who works on what.

use anyhow::Context;
use runs::write_by_draft;
use std::{
    fs::{self, File},
    io::Write,
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

/// A claim whose holder has not said anything for so long is void.
const CLAIM_LASTS: Duration = Duration::from_mins(10);
/// Folder of the claims.
const CLAIMS: &str = "claims";

/// A folder that processes share.
#[derive(Debug, Clone)]
pub(crate) struct SharedFolder(PathBuf);

impl SharedFolder {
    pub(crate) fn new(path: &Path) -> Self {
        Self(path.to_owned())
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// Makes the folder with these folders in it, and one for claims, where they are missing.
    pub(crate) fn make(&self, inner: &[&str]) -> anyhow::Result<()> {
        for folder in inner.iter().chain([&CLAIMS]).map(|inner| self.0.join(inner)) {
            fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
        }
        Ok(())
    }

    pub(crate) fn has(&self, name: &Path) -> bool {
        self.0.join(name).exists()
    }

    /// Writes a file whole or not at all: under another name, to the disk, then renamed.
    pub(crate) fn publish(&self, name: &Path, bytes: &[u8]) -> anyhow::Result<()> {
        let file = self.0.join(name);
        let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default().as_nanos();
        let draft = file.with_extension(format!("draft-{}-{now}", std::process::id()));
        write_by_draft(&file, &draft, bytes).with_context(|| format!("writing {}", file.display()))
    }

    /// Removes what killed processes have left in these folders.
    pub(crate) fn tidy(&self, inner: &[&str]) {
        for folder in inner.iter().map(|inner| self.0.join(inner)) {
            let files = fs::read_dir(folder).into_iter().flatten().flatten();
            let is_draft = |file: &PathBuf| {
                file.extension().is_some_and(|extension| extension.to_string_lossy().starts_with("draft-"))
            };
            // A draft that stays behind harms nobody.
            files.map(|file| file.path()).filter(is_draft).for_each(|file| drop(fs::remove_file(file)));
        }
    }

    fn claim_file(&self, name: &str) -> PathBuf {
        self.0.join(CLAIMS).join(name)
    }

    /// Takes something for this process alone; false if another one has it.
    pub(crate) fn claim(&self, name: &str) -> bool {
        let claim = self.claim_file(name);
        if is_void(&claim) {
            // Two that find it void do at worst the same work twice.
            let _ = fs::remove_file(&claim);
        }
        let Ok(mut made) = File::create_new(&claim) else { return false };
        // Without its holder a claim is void when it is old.
        let _ = write!(made, "{} {}", host(), std::process::id());
        true
    }

    /// Says that the holder of a claim is alive.
    pub(crate) fn keep_claim(&self, name: &str) {
        let touched = File::options().write(true).open(self.claim_file(name));
        // Without it the work is at worst done twice.
        drop(touched.and_then(|claim| claim.set_modified(SystemTime::now())));
    }

    /// Gives something back.
    pub(crate) fn release(&self, name: &str) {
        // A claim that stays is void after a while.
        let _ = fs::remove_file(self.claim_file(name));
    }
}

/// Whether the holder of a claim is gone: silent for long, or a process of this machine that has ended.
fn is_void(claim: &Path) -> bool {
    let age = fs::metadata(claim).and_then(|claim| claim.modified());
    if age.is_ok_and(|at| at.elapsed().unwrap_or_default() > CLAIM_LASTS) {
        return true;
    }
    let holder = fs::read_to_string(claim).unwrap_or_default();
    let here = format!("{} ", host());
    let process = holder.strip_prefix(&here).and_then(|process| process.parse::<u32>().ok());
    let processes = Path::new("/proc");
    processes.join("self").exists()
        && process.is_some_and(|process| !processes.join(process.to_string()).exists())
}

/// The name of this machine; two with one name do at worst the same work twice.
fn host() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    name.split_whitespace().next().unwrap_or("?").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_is_taken_once_and_void_when_its_holder_is_silent() {
        let here = tempfile::tempdir().expect("a folder");
        let folder = SharedFolder::new(here.path());
        folder.make(&[]).expect("a folder");
        assert!(folder.claim("3") && !folder.claim("3") && folder.claim("4"));
        let silent = File::options().write(true).open(here.path().join("claims/3")).expect("a claim");
        silent.set_modified(SystemTime::now() - CLAIM_LASTS - Duration::from_secs(1)).expect("set");
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
    fn a_file_is_published_whole_and_drafts_are_tidied() {
        let here = tempfile::tempdir().expect("a folder");
        let folder = SharedFolder::new(here.path());
        folder.publish(Path::new("a.json"), b"{}").expect("written");
        fs::write(here.path().join("a.draft-1-2"), "half").expect("written");
        folder.tidy(&["."]);
        let names: Vec<_> =
            fs::read_dir(here.path()).expect("read").flatten().map(|file| file.file_name()).collect();
        assert_eq!(names, ["a.json"]);
    }
}
