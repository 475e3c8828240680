//! A run on disk: its folder, who writes to it, how it ended.

mod kept;
mod standing;

pub(crate) use kept::Kept;
pub(crate) use standing::{Standing, end_is_missing, journal_doubt, standing};

use crate::{
    failure::bad_input,
    preflight::{LogsError, make_logs},
};
use anyhow::Context;
use jiff::Timestamp;
use recording::{FAILURE_FILE, JOURNAL_FILE};
use report::Summary;
use sha2::{Digest, Sha256};
use standing::ReportFile;
use std::{
    fmt::Write as _,
    fs::{self, File, OpenOptions},
    io::{self, Read, Write},
    path::{Path, PathBuf},
    time::SystemTime,
};

const REPORT_FILE: &str = "report.json";
const REPORT_DRAFT: &str = "report.json.part";
const LOCK_FILE: &str = "run.lock";
/// A folder with one of these files is that of a run.
const SIGNS: [&str; 4] = [JOURNAL_FILE, REPORT_FILE, LOCK_FILE, FAILURE_FILE];
/// Space that is taken for the report when a run starts, bytes, so that a disk that is full at the end has room for it.
const REPORT_RESERVE: usize = 256 << 10;

/// The folder of a run that is being written; nobody else writes to it.
pub(crate) struct RunFolder {
    path: PathBuf,
    /// Locked as long as this process lives; a killed process leaves it unlocked.
    _lock: File,
}

impl RunFolder {
    /// Makes a new folder `<utc>-<scenario>-<planner>-<seed>`, with a number behind it if that exists.
    ///
    /// # Errors
    /// The folder for runs cannot take one, as [`make_logs`] says.
    pub(crate) fn create(logs: &Path, scenario: &str, planner: &str, seed: u64) -> anyhow::Result<Self> {
        make_logs(logs).map_err(LogsError::refuse)?;
        let refused = |error| not_writable(logs, &error);
        let name = format!("{}-{}-{}-{seed}", utc(SystemTime::now()), plain(scenario), plain(planner));
        let path = fresh_folder(logs, &name)?;
        let lock = File::create_new(path.join(LOCK_FILE)).map_err(refused)?;
        lock.try_lock().map_err(io::Error::from).with_context(|| locking(&path))?;
        fs::write(path.join(REPORT_DRAFT), vec![b'\n'; REPORT_RESERVE]).map_err(refused)?;
        Ok(Self { path, _lock: lock })
    }

    /// Where it is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the report, whole or not at all.
    pub(crate) fn write_report(&self, summary: &Summary) -> anyhow::Result<()> {
        let journal_bytes = fs::metadata(self.path.join(JOURNAL_FILE)).ok().map(|journal| journal.len());
        let report = ReportFile { summary, journal_bytes };
        let text = serde_json::to_string_pretty(&report).context("writing the report as JSON")? + "\n";
        let (draft, final_name) = (self.path.join(REPORT_DRAFT), self.path.join(REPORT_FILE));
        replace_bytes(&draft, text.as_bytes()).with_context(|| format!("writing {}", draft.display()))?;
        fs::rename(&draft, &final_name).with_context(|| format!("writing {}", final_name.display()))
    }
}

/// Writes over the bytes of a file, so that the space they take is used, then cuts off what is left of them.
fn replace_bytes(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = OpenOptions::new().write(true).create(true).truncate(false).open(path)?;
    file.write_all(bytes)?;
    file.set_len(bytes.len() as u64)?;
    file.sync_all()
}

/// A moment as the names of runs begin; a clock before 1970 or after 9999 counts as the nearest moment between.
pub(crate) fn utc(moment: SystemTime) -> String {
    let time = Timestamp::try_from(moment.max(SystemTime::UNIX_EPOCH)).unwrap_or(Timestamp::MAX);
    time.strftime("%Y%m%dT%H%M%SZ").to_string()
}

fn locking(path: &Path) -> String {
    format!("locking the folder of the run: {}", path.display())
}

fn not_writable(logs: &Path, error: &io::Error) -> anyhow::Error {
    LogsError::NotWritable { logs: logs.to_owned(), why: error.to_string() }.refuse()
}

fn fresh_folder(logs: &Path, name: &str) -> anyhow::Result<PathBuf> {
    for attempt in 1..1000 {
        let numbered = if attempt == 1 { name.to_owned() } else { format!("{name}-{attempt}") };
        let path = logs.join(numbered);
        match fs::create_dir(&path) {
            Ok(()) => return Ok(path),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(not_writable(logs, &error)),
        }
    }
    anyhow::bail!("a thousand runs named {name} exist already: {}", logs.display())
}

/// A name without anything that a file system or a shell could mind.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' }).collect()
}

/// SHA-256 of a file, hexadecimal.
pub(crate) fn sha256(path: &Path) -> io::Result<String> {
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file"));
    }
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

/// Folders of past runs, oldest first; also those that have lost their journal.
pub(crate) fn past_runs(logs: &Path) -> anyhow::Result<Vec<PathBuf>> {
    if !logs.exists() {
        return Ok(Vec::new());
    }
    let entries =
        fs::read_dir(logs).with_context(|| format!("reading the folder of runs: {}", logs.display()))?;
    let mut folders: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| SIGNS.iter().any(|name| path.join(name).exists()))
        .collect();
    folders.sort();
    Ok(folders)
}

/// The folder of a run that the user named by path or by name.
pub(crate) fn find(run: &Path, logs: &Path) -> anyhow::Result<PathBuf> {
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
mod tests;
