//! A run on disk: its folder, who writes to it, how it ended.

use crate::failure::bad_input;
use anyhow::Context;
use recording::JOURNAL_FILE;
use report::Summary;
use sha2::{Digest, Sha256};
use std::{
    fmt::Write as _,
    fs::{self, File, TryLockError},
    io::{self, Read, Write},
    path::{Path, PathBuf},
};

const REPORT_FILE: &str = "report.json";
const LOCK_FILE: &str = "run.lock";

/// The folder of a run that is being written; nobody else writes to it.
pub struct RunFolder {
    path: PathBuf,
    /// Locked as long as this process lives; a killed process leaves it unlocked.
    _lock: File,
}

impl RunFolder {
    /// Makes a new folder `<utc>-<scenario>-<planner>-<seed>`, with a number behind it if that exists.
    pub fn create(logs: &Path, scenario: &str, planner: &str, seed: u64) -> anyhow::Result<Self> {
        fs::create_dir_all(logs).map_err(|error| {
            let place = logs.display();
            bad_input(format!(
                "the folder for runs cannot be made: {error}; choose another with --logs: {place}"
            ))
        })?;
        let now = jiff::Timestamp::now().strftime("%Y%m%dT%H%M%SZ").to_string();
        let name = format!("{now}-{}-{}-{seed}", plain(scenario), plain(planner));
        let path = fresh_folder(logs, &name)?;
        let lock = File::create_new(path.join(LOCK_FILE)).with_context(|| locking(&path))?;
        lock.try_lock().map_err(io::Error::from).with_context(|| locking(&path))?;
        Ok(Self { path, _lock: lock })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the report, whole or not at all.
    pub fn write_report(&self, summary: &Summary) -> anyhow::Result<()> {
        let text = serde_json::to_string_pretty(summary).context("writing the report as JSON")?;
        let (draft, final_name) = (self.path.join("report.json.part"), self.path.join(REPORT_FILE));
        let mut file = File::create(&draft).with_context(|| format!("writing {}", draft.display()))?;
        file.write_all(text.as_bytes())
            .and_then(|()| file.write_all(b"\n"))
            .and_then(|()| file.sync_all())?;
        fs::rename(&draft, &final_name).with_context(|| format!("writing {}", final_name.display()))
    }
}

fn locking(path: &Path) -> String {
    format!("locking the folder of the run: {}", path.display())
}

fn fresh_folder(logs: &Path, name: &str) -> anyhow::Result<PathBuf> {
    for attempt in 1..1000 {
        let numbered = if attempt == 1 { name.to_owned() } else { format!("{name}-{attempt}") };
        let path = logs.join(numbered);
        match fs::create_dir(&path) {
            Ok(()) => return Ok(path),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error).with_context(|| format!("making the folder {}", path.display())),
        }
    }
    anyhow::bail!("a thousand runs named {name} exist already: {}", logs.display())
}

/// A name without anything that a file system or a shell could mind.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' }).collect()
}

/// How a past run stands.
#[derive(Debug, Clone, PartialEq)]
pub enum Standing {
    /// It ended and its report was written.
    Ended(Box<Summary>),
    /// Somebody is writing to it.
    Running,
    /// It was killed; journal and recording hold everything up to then.
    Crashed,
    /// Its report cannot be read.
    Unreadable(String),
}

/// How the run in a folder stands.
pub fn standing(folder: &Path) -> Standing {
    if let Ok(text) = fs::read_to_string(folder.join(REPORT_FILE)) {
        return match serde_json::from_str(&text) {
            Ok(summary) => Standing::Ended(Box::new(summary)),
            Err(error) => Standing::Unreadable(format!("{REPORT_FILE}: {error}")),
        };
    }
    let locked = File::open(folder.join(LOCK_FILE))
        .map(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)));
    if locked.unwrap_or(false) { Standing::Running } else { Standing::Crashed }
}

/// SHA-256 of a file, hexadecimal.
pub fn sha256(path: &Path) -> io::Result<String> {
    let (mut file, mut hasher, mut chunk) = (File::open(path)?, Sha256::new(), vec![0; 1 << 18]);
    loop {
        match file.read(&mut chunk)? {
            0 => break,
            length => hasher.update(&chunk[..length]),
        }
    }
    Ok(hasher.finalize().iter().fold(String::with_capacity(64), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    }))
}

/// What speaks against the journal of a run whose digest is this: its report names another one.
pub fn journal_doubt(folder: &Path, sha256: Option<&str>) -> Option<String> {
    let report: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.join(REPORT_FILE)).ok()?).ok()?;
    let then = report.get("events_sha256")?.as_str()?;
    (then != sha256?).then(|| {
        "the journal is not the one that was written: it does not have the SHA-256 of the report".to_owned()
    })
}

/// Folders of past runs, oldest first.
pub fn past_runs(logs: &Path) -> anyhow::Result<Vec<PathBuf>> {
    if !logs.exists() {
        return Ok(Vec::new());
    }
    let entries =
        fs::read_dir(logs).with_context(|| format!("reading the folder of runs: {}", logs.display()))?;
    let mut folders: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.join(JOURNAL_FILE).exists())
        .collect();
    folders.sort();
    Ok(folders)
}

/// The folder of a run that the user named by path or by name.
pub fn find(run: &Path, logs: &Path) -> anyhow::Result<PathBuf> {
    let candidates = [run.to_path_buf(), logs.join(run)];
    let found = candidates.into_iter().find(|path| path.join(JOURNAL_FILE).exists());
    found.ok_or_else(|| {
        bad_input(format!(
            "there is no run {}: neither a folder with {JOURNAL_FILE} nor a name in {}; `tankops runs` lists them",
            run.display(),
            logs.display()
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_is_being_written_is_running_and_then_crashed() {
        let logs = tempfile::tempdir().unwrap();
        let folder = RunFolder::create(logs.path(), "demo tank/7", "rpf", 1).unwrap();
        let name = folder.path().file_name().unwrap().to_str().unwrap().to_owned();
        assert!(name.ends_with("-demo-tank-7-rpf-1"), "{name}");
        assert_eq!(standing(folder.path()), Standing::Running);
        let path = folder.path().to_path_buf();
        drop(folder);
        assert_eq!(standing(&path), Standing::Crashed);
    }

    #[test]
    fn two_runs_in_one_second_get_two_folders() {
        let logs = tempfile::tempdir().unwrap();
        let folders: Vec<RunFolder> =
            (0..3).map(|_| RunFolder::create(logs.path(), "demo", "rpf", 1).unwrap()).collect();
        assert_ne!(folders[0].path(), folders[1].path());
        assert_ne!(folders[1].path(), folders[2].path());
    }
}
