//! Checks whether runs can be kept in the folder for runs, before the console takes over the terminal and before anything
//! moves.

use crate::{
    error::{RunError, is_of_machine},
    log::CLOSE_TIMEOUT,
};
use recording::{JOURNAL_FILE, Options, RECORDING_FILE, RunRecorder, events_sha256};
use rustix::process::{Resource, getrlimit};
use std::{
    fs::{self, File},
    io::{self, Write},
    path::{Path, PathBuf},
    sync::atomic::{AtomicU64, Ordering},
};

/// Minimum free space for a run, bytes. A mission takes about 100 MB an hour, so this is enough for ten minutes.
const MIN_FREE_BYTES: u64 = 16 << 20;
/// Size of the test file, bytes: one block on common file systems.
const PROBE: [u8; 4096] = [b'\n'; 4096];

/// The reason why no run can be kept in a folder.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum LogsError {
    /// A part of the path is a file.
    #[error("cannot keep runs in {}: {} is a file, not a folder; choose a folder with --logs", logs.display(), file.display())]
    NotAFolder { logs: PathBuf, file: PathBuf },
    /// The folder does not exist, and the system refuses to create it.
    #[error("cannot keep runs in {}: the folder cannot be created ({why}); choose another one with --logs", logs.display())]
    CannotCreate { logs: PathBuf, why: String },
    /// The system refuses to create, write or remove a file in the folder.
    #[error("cannot keep runs in {}: the folder is not writable ({why}); choose another one with --logs", logs.display())]
    NotWritable { logs: PathBuf, why: String },
    /// The disk is full or faulty.
    #[error("cannot keep runs in {}: {why}; free some space or choose another folder with --logs", logs.display())]
    Disk { logs: PathBuf, why: String },
    /// There is not enough free space.
    #[error(
        "cannot keep runs in {}: {} MB are free, but at least {} MB are needed; free some space or choose another folder with \
         --logs", logs.display(), megabytes(*free_bytes), megabytes(*needed_bytes)
    )]
    NoSpace { logs: PathBuf, free_bytes: u64, needed_bytes: u64 },
    /// The system's limit on the size of files is too low for a run.
    #[error(
        "cannot keep runs in {}: the system limits files to {} kB, but at least {} MB are needed; raise the limit: `ulimit -f {}`",
        logs.display(), limit_bytes / 1000, megabytes(MIN_FREE_BYTES), MIN_FREE_BYTES >> 10
    )]
    FilesTooSmall { logs: PathBuf, limit_bytes: u64 },
}

/// Checks that runs can be kept in a folder, using the same checks as the start of a run, and leaves nothing behind.
///
/// # Errors
/// [`RunError::Logs`].
pub fn check_logs(logs: &Path) -> Result<(), RunError> {
    Ok(check(logs)?)
}

fn check(logs: &Path) -> Result<(), LogsError> {
    let missing: Vec<PathBuf> =
        logs.ancestors().take_while(|folder| is_missing(folder)).map(Path::to_owned).collect();
    let checked = make_logs(logs);
    for folder in missing {
        // Only folders that were created above are removed, and only while they are empty: a different run may have begun
        // there.
        let _ = fs::remove_dir(folder);
    }
    checked
}

/// The number of recorder checks begun by this process.
static CHECKS: AtomicU64 = AtomicU64::new(0);

/// Writes a test recording to a separate folder inside the folder for runs, reads it back, and leaves nothing behind.
/// Returns the length of the recording in bytes.
///
/// # Errors
/// The recording cannot be written, or is different when it is read back.
pub fn check_recorder(logs: &Path) -> Result<u64, RunError> {
    make_logs(logs)?;
    // Two checks at the same time must not use one folder.
    let number = CHECKS.fetch_add(1, Ordering::Relaxed);
    let folder = logs.join(format!(".recorder-{}-{number}", std::process::id()));
    let written = record_and_read(&folder);
    let _ = fs::remove_dir_all(&folder);
    written
}

fn record_and_read(folder: &Path) -> Result<u64, RunError> {
    let trying = |what: &str| RunError::during(format!("{what} {}", folder.display()));
    fs::create_dir_all(folder).map_err(trying("creating"))?;
    let finished = RunRecorder::start(folder, Options::default())?.finish(CLOSE_TIMEOUT);
    if let Some(error) = finished.error {
        return Err(RunError::Logs(error));
    }
    let (journal, recording) = (folder.join(JOURNAL_FILE), folder.join(RECORDING_FILE));
    let hash = events_sha256(&journal).map_err(trying("reading"))?;
    if finished.events_sha256.as_ref() != Some(&hash) {
        return Err(RunError::Logs(format!(
            "the test file differs from what was written: {}",
            journal.display()
        )));
    }
    let bytes = |file: &Path| fs::metadata(file).map(|data| data.len()).map_err(trying("reading"));
    Ok(bytes(&journal)? + bytes(&recording)?)
}

impl LogsError {
    /// The system refused to create, write or remove a file in the folder.
    pub(crate) fn writing(logs: &Path, error: &io::Error) -> Self {
        let (logs, why) = (logs.to_owned(), error.to_string());
        if is_of_machine(error) { Self::Disk { logs, why } } else { Self::NotWritable { logs, why } }
    }
}

impl From<LogsError> for RunError {
    fn from(error: LogsError) -> Self {
        match error {
            LogsError::FilesTooSmall { .. } | LogsError::NoSpace { .. } | LogsError::Disk { .. } => {
                Self::Machine(error.to_string())
            }
            _ => Self::Logs(error.to_string()),
        }
    }
}

/// Creates the folder for runs if it does not exist. Checks that a file can be written and removed there, and that there
/// is space for ten minutes of a mission.
///
/// # Errors
/// See [`LogsError`].
pub(crate) fn make_logs(logs: &Path) -> Result<(), LogsError> {
    if let Some(file) = file_on_the_way(logs) {
        return Err(LogsError::NotAFolder { logs: logs.to_owned(), file });
    }
    fs::create_dir_all(logs).map_err(|error| {
        let (logs, why) = (logs.to_owned(), error.to_string());
        if is_of_machine(&error) {
            LogsError::Disk { logs, why }
        } else {
            LogsError::CannotCreate { logs, why }
        }
    })?;
    check_folder(logs)
}

fn check_folder(logs: &Path) -> Result<(), LogsError> {
    // A file system that does not report its free space is not treated as full.
    if let Some(free_bytes) = free_bytes(logs).filter(|free_bytes| *free_bytes < MIN_FREE_BYTES) {
        return Err(LogsError::NoSpace { logs: logs.to_owned(), free_bytes, needed_bytes: MIN_FREE_BYTES });
    }
    if let Some(limit) = getrlimit(Resource::Fsize).current.filter(|limit| *limit < MIN_FREE_BYTES) {
        return Err(LogsError::FilesTooSmall { logs: logs.to_owned(), limit_bytes: limit });
    }
    probe(logs).map_err(|error| LogsError::writing(logs, &error))
}

/// The first part of a path that is a file; `None` if there is none.
fn file_on_the_way(path: &Path) -> Option<PathBuf> {
    let existing = path.ancestors().find(|part| part.exists())?;
    (!existing.is_dir()).then(|| existing.to_owned())
}

fn is_missing(folder: &Path) -> bool {
    !folder.as_os_str().is_empty() && folder.symlink_metadata().is_err()
}

/// Free space where runs are kept, or where the folder for runs would be created, bytes; `None` if the system does not
/// report it.
pub fn free_bytes(logs: &Path) -> Option<u64> {
    let folder = logs.ancestors().find(|part| part.is_dir()).unwrap_or(Path::new("."));
    let space = rustix::fs::statvfs(folder).ok()?;
    (space.f_blocks > 0).then(|| space.f_bavail.saturating_mul(space.f_frsize))
}

/// Creates a file, writes to it and removes it. Checking permissions alone would not reveal quotas and read-only mounts.
fn probe(folder: &Path) -> io::Result<()> {
    let path = folder.join(format!(".probe-{}-{:?}", std::process::id(), std::thread::current().id()));
    let mut file = File::create_new(&path)?;
    let written = file.write_all(&PROBE).and_then(|()| file.flush());
    written.and(fs::remove_file(&path))
}

fn megabytes(bytes: u64) -> String {
    format!("{:.1}", bytes as f64 / f64::from(1 << 20))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_can_be_created_is_fine_and_not_left_behind() {
        let place = tempfile::tempdir().unwrap();
        assert_eq!(check(place.path()), Ok(()));
        assert_eq!(check(&place.path().join("a/b/logs")), Ok(()));
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 0);
    }

    #[test]
    fn checks_of_the_recorder_at_the_same_time_do_not_disturb_each_other() {
        let place = tempfile::tempdir().unwrap();
        std::thread::scope(|scope| {
            let checks: Vec<_> = (0..4)
                .map(|_| {
                    scope
                        .spawn(|| (0..3).map(|_| check_recorder(place.path())).collect::<Result<Vec<_>, _>>())
                })
                .collect();
            for check in checks {
                check.join().unwrap().unwrap();
            }
        });
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_file_instead_of_a_folder_is_named() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("file");
        fs::write(&file, "precious").unwrap();
        for logs in [file.clone(), file.join("logs")] {
            let error = check(&logs).expect_err("it is a file");
            assert_eq!(error, LogsError::NotAFolder { logs, file: file.clone() });
            assert!(error.to_string().contains("is a file, not a folder"), "{error}");
        }
        assert_eq!(fs::read(&file).unwrap(), b"precious");
    }

    #[test]
    fn a_folder_that_takes_no_file_is_refused() {
        // Not even root creates files in it.
        let error = check(Path::new("/proc/self")).expect_err("nothing can be written");
        assert!(matches!(error, LogsError::NotWritable { .. }), "{error}");
        let error = check(Path::new("/proc/self/logs")).expect_err("nothing can be created");
        assert!(matches!(error, LogsError::CannotCreate { .. }), "{error}");
    }

    #[test]
    fn too_little_space_is_reported_in_numbers() {
        let (logs, free_bytes) = (PathBuf::from("logs"), 943_718);
        let error = LogsError::NoSpace { logs, free_bytes, needed_bytes: MIN_FREE_BYTES };
        assert!(error.to_string().contains("0.9 MB are free, but at least 16.0 MB are needed"), "{error}");
    }

    #[test]
    fn a_full_disk_is_a_fault_of_the_machine_and_a_wrong_folder_is_one_of_the_input() {
        let logs = || PathBuf::from("logs");
        let full = LogsError::NoSpace { logs: logs(), free_bytes: 0, needed_bytes: MIN_FREE_BYTES };
        let faulty = LogsError::writing(&logs(), &io::ErrorKind::QuotaExceeded.into());
        for error in [full, faulty] {
            assert!(!RunError::from(error).is_input());
        }
        let wrong = LogsError::CannotCreate { logs: logs(), why: "permission denied".into() };
        assert!(RunError::from(wrong).is_input());
    }
}
