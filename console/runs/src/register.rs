//! The register of signatures: the signed reports of a user, kept apart from the runs. It shows whether a list in the
//! folder of a run was changed or lacks a report.

use crate::error::RunError;
use foreign::read_regular;
use report::document::{Revision, SignedRun};
use std::{
    fs::{self, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

/// The register: a file with one signed report per line, as JSON; lines are only ever appended.
#[derive(Debug, Clone)]
pub struct Register(Option<PathBuf>);

impl Register {
    /// Creates a register that is stored in a file. If there is no file, nothing is registered, and lost reports are not
    /// noticed.
    pub fn at(file: Option<PathBuf>) -> Self {
        Self(file)
    }

    /// Adds a signed report.
    ///
    /// # Errors
    /// The system refuses to write the register.
    pub(crate) fn add(&self, revision: &Revision) -> Result<(), RunError> {
        let Some(file) = &self.0 else { return Ok(()) };
        let line = serde_json::to_string(revision).map_err(io::Error::from);
        line.and_then(|line| append(file, &line))
            .map_err(RunError::during(format!("writing the register of signatures: {}", file.display())))
    }

    /// The signed reports on a run that has one of these names.
    ///
    /// # Errors
    /// The register cannot be read.
    pub(crate) fn of(&self, names: &[String]) -> Result<Vec<Revision>, RunError> {
        self.about(|run| names.contains(&run.run))
    }

    /// The signed reports on runs for which `is_meant` is true.
    ///
    /// # Errors
    /// The register cannot be read.
    pub(crate) fn about(&self, is_meant: impl Fn(&SignedRun) -> bool) -> Result<Vec<Revision>, RunError> {
        let Some(file) = &self.0 else { return Ok(Vec::new()) };
        let text = match read_regular(file) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            Err(error) => {
                return Err(RunError::during(format!(
                    "reading the register of signatures: {}",
                    file.display()
                ))(error));
            }
        };
        let mut found = Vec::new();
        for (number, line) in (1..).zip(text.lines()) {
            let signed: Revision = serde_json::from_str(line).map_err(|error| RunError::Damaged {
                file: file.clone(),
                why: format!("line {number}: {error}"),
            })?;
            if signed.runs.iter().any(&is_meant) {
                found.push(signed);
            }
        }
        Ok(found)
    }

    /// The signed report that was written to the file with this absolute path; `None` if there is none, or if the
    /// register cannot be read.
    pub fn signed_as(&self, file: &Path) -> Option<Revision> {
        let all = self.about(|_| true).unwrap_or_default();
        all.into_iter().find(|revision| Path::new(&revision.file) == file)
    }

    /// The signed report with this document number and letter; `None` if there is none, or if the register cannot be
    /// read.
    pub fn numbered(&self, number: &str, letter: &str) -> Option<Revision> {
        let all = self.about(|_| true).unwrap_or_default();
        all.into_iter().find(|revision| revision.number == number && revision.revision == letter)
    }

    /// Path of the register's file, for display.
    pub(crate) fn shown(&self) -> String {
        self.0.as_ref().map(|file| file.display().to_string()).unwrap_or_default()
    }
}

/// Appends a line and flushes it to disk.
fn append(file: &Path, line: &str) -> io::Result<()> {
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder)?;
    }
    let mut file = OpenOptions::new().append(true).create(true).open(file)?;
    // Written in one call, so that the lines of two processes do not mix.
    file.write_all(format!("{line}\n").as_bytes())?;
    file.sync_all()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use report::document::Signature;

    fn signed(run: &str, sha256: &str) -> Revision {
        Revision {
            number: "1-1".into(),
            revision: "A".into(),
            signature: Signature { by: "L. Kern".into(), at: "2026-11-22 04:01".into() },
            file: "a.html".into(),
            sha256: sha256.into(),
            runs: vec![SignedRun { run: run.into(), journal_sha256: None, recording_sha256: None }],
        }
    }

    #[test]
    fn the_signed_reports_of_a_run_are_found_by_any_of_its_names() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("state/signatures");
        let register = Register::at(Some(file.clone()));
        let of = |names: &[&str]| register.of(&names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>());
        assert_eq!(of(&["a"]).unwrap(), []);
        let (of_a, of_b) = (signed("a", "5a"), signed("b", "5b"));
        register.add(&of_a).unwrap();
        register.add(&of_b).unwrap();
        assert_eq!(of(&["a"]).unwrap(), std::slice::from_ref(&of_a));
        assert_eq!(of(&["renamed", "b"]).unwrap(), [of_b]);
        assert_eq!(of(&["c"]).unwrap(), []);
        fs::write(&file, "{}\n").unwrap();
        let damaged = of(&["a"]).unwrap_err().to_string();
        assert!(damaged.contains("signatures is damaged: line 1: missing field"), "{damaged}");
        assert_eq!(Register::at(None).of(&["a".to_owned()]).unwrap(), []);
        Register::at(None).add(&of_a).unwrap();
    }
}
