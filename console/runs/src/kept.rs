//! Whether a run is on disk, for the last message about it.

use crate::{error::RunError, files::REPORT_FILE, folder::RunFolder};
use recording::{Finished, JOURNAL_FILE};
use std::path::PathBuf;

/// Whether all files of a run that has ended were written, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Kept {
    folder: PathBuf,
    problem: Option<String>,
}

impl Kept {
    /// `report` is the result of writing the report.
    pub(crate) fn new(folder: &RunFolder, finished: &Finished, report: &Result<(), RunError>) -> Self {
        let unwritten = || report.as_ref().err().map(ToString::to_string);
        Self { folder: folder.path().to_owned(), problem: finished.error.clone().or_else(unwritten) }
    }

    /// The reason why the run is not kept; `None` if it is kept. Checks the disk again, because the console may stay
    /// open long after the end of the run.
    pub fn problem(&self) -> Option<String> {
        let mut missing = [JOURNAL_FILE, REPORT_FILE].into_iter().map(|name| self.folder.join(name));
        let missing =
            || missing.find(|path| !path.is_file()).map(|path| format!("{} is missing", path.display()));
        self.problem.clone().or_else(missing)
    }

    /// Name of the folder.
    pub fn name(&self) -> String {
        self.folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// The last message about the run.
    pub fn text(&self) -> String {
        let folder = self.folder.display();
        match self.problem() {
            None => format!("run kept in {folder}"),
            Some(why) if self.folder.join(JOURNAL_FILE).is_file() => format!(
                "run NOT kept in {folder}: {why}; `tankops recover {} --by NAME` completes it from its journal",
                self.name()
            ),
            Some(why) => format!("run NOT kept in {folder}: {why}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use account::Summary;
    use recording::{Options, RunRecorder};
    use std::{fs, time::Duration};

    fn ended(logs: &std::path::Path, meanwhile: impl Fn(&RunFolder)) -> (RunFolder, Kept) {
        let folder = RunFolder::create(logs, "demo", "rpf", 1).unwrap();
        let recorder = RunRecorder::start(folder.path(), Options::default()).unwrap();
        meanwhile(&folder);
        let finished = recorder.finish(Duration::from_secs(20));
        let report = folder.write_report(&Summary::default());
        let kept = Kept::new(&folder, &finished, &report);
        (folder, kept)
    }

    #[test]
    fn a_whole_run_is_kept_as_long_as_it_is_there() {
        let logs = tempfile::tempdir().unwrap();
        let (folder, kept) = ended(logs.path(), |_| {});
        assert_eq!(kept.text(), format!("run kept in {}", folder.path().display()));
        assert_eq!(kept.problem(), None);
        fs::remove_dir_all(folder.path()).unwrap();
        assert!(kept.text().contains("NOT kept") && kept.text().contains("is missing"), "{}", kept.text());
        assert!(kept.problem().is_some());
    }

    #[test]
    fn a_run_whose_folder_was_deleted_or_whose_report_is_missing_is_not_kept() {
        let logs = tempfile::tempdir().unwrap();
        let (_, kept) = ended(logs.path(), |folder| fs::remove_dir_all(folder.path()).unwrap());
        assert!(kept.text().contains("NOT kept") && kept.text().contains("was deleted"), "{}", kept.text());
        let (_, kept) = ended(logs.path(), |folder| fs::create_dir(folder.path().join(REPORT_FILE)).unwrap());
        assert!(kept.text().contains("NOT kept") && kept.text().contains(REPORT_FILE), "{}", kept.text());
        assert!(kept.problem().is_some());
    }
}
