//! The folder of a run: creating, finding and listing it.

use crate::{
    error::RunError,
    files::{LOCK_FILE, REPORT_FILE, plain, utc},
    logs::{LogsError, make_logs},
    report_file::ReportFile,
    whole::{draft_of, write_whole},
};
use account::Summary;
use recording::{FAILURE_FILE, JOURNAL_FILE, PLAIN_JOURNAL_FILE, RECORDING_FILE, journal_of};
use report::document::Recovered;
use std::{
    fs::{self, File, TryLockError},
    io,
    path::{Path, PathBuf},
    time::SystemTime,
};

/// A folder that contains one of these files is the folder of a run.
const SIGNS: [&str; 5] = [JOURNAL_FILE, PLAIN_JOURNAL_FILE, REPORT_FILE, LOCK_FILE, FAILURE_FILE];
/// Space reserved for the report when a run starts, bytes, so that the report can still be written if the disk is full at
/// the end.
const REPORT_RESERVE: usize = 256 << 10;

/// Whether a folder is the folder of a run.
pub fn is_run(folder: &Path) -> bool {
    SIGNS.iter().any(|name| folder.join(name).exists())
}

/// The folder of a run that is being written; no other process writes to it.
pub struct RunFolder {
    path: PathBuf,
    /// Locked as long as this process lives; if the process is killed, the system releases the lock.
    _lock: File,
}

impl RunFolder {
    /// Creates a new folder `<utc>-<scenario>-<planner>-<seed>`, with a number appended if a folder of that name exists.
    ///
    /// # Errors
    /// No run can be written to the folder for runs.
    pub fn create(logs: &Path, scenario: &str, planner: &str, seed: u64) -> Result<Self, RunError> {
        make_logs(logs)?;
        let refused = |error| not_writable(logs, &error);
        let name = format!("{}-{}-{}-{seed}", utc(SystemTime::now()), plain(scenario), plain(planner));
        let path = fresh_folder(logs, &name)?;
        let lock = File::create_new(path.join(LOCK_FILE)).map_err(refused)?;
        let locking = || format!("locking the folder of the run: {}", path.display());
        lock.try_lock().map_err(io::Error::from).map_err(RunError::during(locking()))?;
        fs::write(draft_of(&path.join(REPORT_FILE)), vec![b'\n'; REPORT_RESERVE]).map_err(refused)?;
        Ok(Self { path, _lock: lock })
    }

    /// Takes over the folder of a run when no process writes to it any more.
    ///
    /// # Errors
    /// A process is still writing to it.
    pub(crate) fn take(path: &Path) -> Result<Self, RunError> {
        let locking = || format!("locking the folder of the run: {}", path.display());
        let open = File::options().create(true).append(true).open(path.join(LOCK_FILE));
        let lock = open.map_err(RunError::during(locking()))?;
        match lock.try_lock() {
            Ok(()) => Ok(Self { path: path.to_owned(), _lock: lock }),
            Err(TryLockError::WouldBlock) => Err(RunError::Refused(format!(
                "the run in {} is still being written; first end it, or end the process that is writing it",
                path.display()
            ))),
            Err(TryLockError::Error(error)) => Err(RunError::during(locking())(error)),
        }
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the report atomically.
    ///
    /// # Errors
    /// The system refuses to write it.
    pub fn write_report(&self, summary: &Summary) -> Result<(), RunError> {
        self.write_report_of(summary, None)
    }

    /// Like [`RunFolder::write_report`], with `recovered` set if the writer was killed.
    pub(crate) fn write_report_of(
        &self,
        summary: &Summary,
        recovered: Option<&Recovered>,
    ) -> Result<(), RunError> {
        let bytes = |file: &str| fs::metadata(self.path.join(file)).ok().map(|file| file.len());
        let lengths = [JOURNAL_FILE, RECORDING_FILE].map(bytes);
        let file = self.path.join(REPORT_FILE);
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        let text = ReportFile::text(&name, summary, lengths, recovered).map_err(io::Error::from);
        text.and_then(|text| write_whole(&file, text.as_bytes()))
            .map_err(RunError::during(format!("writing {}", file.display())))
    }
}

fn not_writable(logs: &Path, error: &io::Error) -> RunError {
    LogsError::writing(logs, error).into()
}

fn fresh_folder(logs: &Path, name: &str) -> Result<PathBuf, RunError> {
    for attempt in 1..1000 {
        let numbered = if attempt == 1 { name.to_owned() } else { format!("{name}-{attempt}") };
        let path = logs.join(numbered);
        match fs::create_dir(&path) {
            Ok(()) => return Ok(path),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(not_writable(logs, &error)),
        }
    }
    Err(RunError::NoName { name: name.to_owned(), logs: logs.to_owned() })
}

/// The folders of past runs, oldest first, including folders without a journal.
pub(crate) fn past_runs(logs: &Path) -> Result<Vec<PathBuf>, RunError> {
    if !logs.exists() {
        return Ok(Vec::new());
    }
    let reading = format!("reading the folder of runs: {}", logs.display());
    let entries = fs::read_dir(logs).map_err(RunError::during(reading))?;
    let mut folders: Vec<PathBuf> =
        entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|path| is_run(path)).collect();
    folders.sort();
    for same_second in folders.chunk_by_mut(|a, b| second_of(a) == second_of(b)) {
        if same_second.len() > 1 {
            same_second.sort_by_key(|folder| made(folder));
        }
    }
    Ok(folders)
}

/// The second in which a run began, according to the name of the run.
fn second_of(folder: &Path) -> &[u8] {
    let name = folder.file_name().unwrap_or_default().as_encoded_bytes();
    name.split(|byte| *byte == b'-').next().unwrap_or_default()
}

/// The time at which a run began, taken from its lock file, which is written only once; `None` if that file is missing.
fn made(folder: &Path) -> Option<SystemTime> {
    fs::metadata(folder.join(LOCK_FILE)).and_then(|lock| lock.modified()).ok()
}

/// Finds the folder of a run that the user specified by its path, its name, the beginning of its name, or as `latest`.
///
/// # Errors
/// [`RunError::NoRun`], [`RunError::ManyRuns`].
pub fn find(run: &Path, logs: &Path) -> Result<PathBuf, RunError> {
    let candidates = [run.to_path_buf(), logs.join(run)];
    if let Some(found) = candidates.into_iter().find(|path| journal_of(path).exists()) {
        return Ok(found);
    }
    let missing = || RunError::NoRun { run: run.to_owned(), logs: logs.to_owned() };
    let begin = run.to_str().filter(|begin| !begin.is_empty()).ok_or_else(missing)?;
    let mut fitting = past_runs(logs).unwrap_or_default();
    if begin == "latest" {
        return fitting.pop().ok_or_else(missing);
    }
    let name =
        |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    fitting.retain(|path| name(path).starts_with(begin));
    match &fitting[..] {
        [] => Err(missing()),
        [one] => Ok(one.clone()),
        [first, second, ..] => {
            let (count, some) = (fitting.len(), format!("{}, {}", name(first), name(second)));
            Err(RunError::ManyRuns { begin: begin.to_owned(), count, some })
        }
    }
}

#[cfg(test)]
mod tests;
