//! The register of signatures: the signed reports of a user, kept apart from the runs, so that a list in the folder of a run that
//! has lost one, or was changed, is noticed.

use crate::error::RunError;
use recording::read_regular;
use report::document::Revision;
use std::{
    fs::{self, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

/// The register: a signed report a line, as JSON; lines are only ever added.
#[derive(Debug, Clone)]
pub struct Register(Option<PathBuf>);

impl Register {
    /// The register in a file; without one nothing is kept and nothing is noticed.
    pub fn at(file: Option<PathBuf>) -> Self {
        Self(file)
    }

    /// Adds a signed report.
    ///
    /// # Errors
    /// The system refuses.
    pub(crate) fn add(&self, revision: &Revision) -> Result<(), RunError> {
        let Some(file) = &self.0 else { return Ok(()) };
        let line = serde_json::to_string(revision).map_err(io::Error::from);
        line.and_then(|line| append(file, &line))
            .map_err(RunError::during(format!("writing the register of signatures: {}", file.display())))
    }

    /// What speaks against the list of signed reports of a run: those of the register that it has not, or not any more as they
    /// were signed.
    ///
    /// # Errors
    /// The register cannot be read.
    pub fn doubts(&self, run: &str, listed: &[Revision]) -> Result<Vec<String>, RunError> {
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
        let mut doubts = Vec::new();
        for (number, line) in (1..).zip(text.lines()) {
            let signed: Revision = serde_json::from_str(line).map_err(|error| RunError::Damaged {
                file: file.clone(),
                why: format!("line {number}: {error}"),
            })?;
            if signed.runs.iter().any(|of| of.run == run) && !listed.contains(&signed) {
                doubts.push(lost(&signed, run, file));
            }
        }
        Ok(doubts)
    }
}

fn lost(signed: &Revision, run: &str, register: &Path) -> String {
    format!(
        "run {run} was signed as revision {} by {} at {} UTC (SHA-256 {}), as {} says, but its signed.json does not list that",
        signed.revision,
        signed.signature.by,
        signed.signature.at,
        signed.sha256,
        register.display()
    )
}

/// Adds a line and puts it on the disk.
fn append(file: &Path, line: &str) -> io::Result<()> {
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder)?;
    }
    let mut file = OpenOptions::new().append(true).create(true).open(file)?;
    // In one piece, so that the lines of two processes do not mix.
    file.write_all(format!("{line}\n").as_bytes())?;
    file.sync_all()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use report::document::{Signature, SignedRun};

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
    fn a_list_that_has_lost_a_signature_or_has_another_digest_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("state/signatures");
        let register = Register::at(Some(file.clone()));
        assert_eq!(register.doubts("a", &[]).unwrap(), Vec::<String>::new());
        let (of_a, of_b) = (signed("a", "5a"), signed("b", "5b"));
        register.add(&of_a).unwrap();
        register.add(&of_b).unwrap();
        assert_eq!(register.doubts("a", std::slice::from_ref(&of_a)).unwrap(), Vec::<String>::new());
        for listed in [vec![], vec![signed("a", "forged")], vec![of_b]] {
            let [lost] = &register.doubts("a", &listed).unwrap()[..] else { panic!("{listed:?}") };
            assert!(lost.starts_with(
                "run a was signed as revision A by L. Kern at 2026-11-22 04:01 UTC (SHA-256 5a)"
            ));
        }
        assert_eq!(register.doubts("c", &[]).unwrap(), Vec::<String>::new());
        fs::write(&file, "{}\n").unwrap();
        let damaged = register.doubts("a", &[]).unwrap_err().to_string();
        assert!(damaged.contains("signatures is damaged: line 1: missing field"), "{damaged}");
        assert_eq!(Register::at(None).doubts("a", &[]).unwrap(), Vec::<String>::new());
        Register::at(None).add(&of_a).unwrap();
    }
}
