//! Signed reports of a run: which there are, and that none is changed.

use crate::{error::RunError, register::Register, whole::write_whole};
use foreign::read_json;
use recording::sha256;
use report::document::Revision;
use std::{
    io,
    path::{Path, PathBuf},
};

/// The list of signed reports in the folder of a run.
pub const SIGNED_FILE: &str = "signed.json";
/// Longest list, bytes: ten thousand signatures.
const MOST_BYTES: u64 = 8 << 20;

/// The signed reports of the run in a folder, in their order.
///
/// # Errors
/// The list cannot be read.
pub fn signed_list(folder: &Path) -> Result<Vec<Revision>, RunError> {
    let path = folder.join(SIGNED_FILE);
    let reading = || RunError::during(format!("reading the list of signed reports: {}", path.display()));
    let text = match read_json(&path, MOST_BYTES) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(reading()(error)),
    };
    serde_json::from_str(&text).map_err(|error| RunError::Damaged { file: path, why: error.to_string() })
}

/// The signed reports of the run in a folder, in their order, and what speaks against them: a file that has another digest than
/// when it was signed, or is not where it was written any more.
///
/// # Errors
/// The list cannot be read.
pub fn signed_reports(folder: &Path) -> Result<(Vec<Revision>, Vec<String>), RunError> {
    let revisions = signed_list(folder)?;
    let doubt = |revision: &Revision| {
        let Revision { revision: letter, file, sha256: then, .. } = revision;
        match sha256(&PathBuf::from(file)) {
            Ok(now) if now == *then => None,
            Ok(now) => Some(format!(
                "signed revision {letter} was changed after it was signed: {file}: expected SHA-256 {then}, found {now}"
            )),
            Err(error) => Some(format!(
                "signed revision {letter} cannot be read: {file}: {error}; expected a file with SHA-256 {then}"
            )),
        }
    };
    let doubts = revisions.iter().filter_map(doubt).collect();
    Ok((revisions, doubts))
}

/// Adds a signed report to the lists of all runs that it is about and to the register, or to none of them.
///
/// # Errors
/// A list cannot be read or written.
pub fn add_signed(folders: &[PathBuf], register: &Register, revision: &Revision) -> Result<(), RunError> {
    let add = |folder: &PathBuf| {
        let mut revisions = signed_list(folder)?;
        revisions.push(revision.clone());
        write_list(folder, &revisions)
    };
    let mut added = 0;
    let all = folders.iter().try_for_each(|folder| add(folder).inspect(|()| added += 1));
    all.and_then(|()| register.add(revision))
        .inspect_err(|_| folders[..added].iter().for_each(|folder| take_back(folder, revision)))
}

/// Takes a report off the list again, if the system lets it.
fn take_back(folder: &Path, revision: &Revision) {
    if let Ok(mut revisions) = signed_list(folder) {
        revisions.retain(|listed| listed != revision);
        let _ = write_list(folder, &revisions);
    }
}

fn write_list(folder: &Path, revisions: &[Revision]) -> Result<(), RunError> {
    let path = folder.join(SIGNED_FILE);
    let text = serde_json::to_string_pretty(revisions).map_err(io::Error::from);
    text.and_then(|text| write_whole(&path, (text + "\n").as_bytes()))
        .map_err(RunError::during(format!("writing the list of signed reports: {}", path.display())))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use report::document::Signature;
    use std::fs;

    #[test]
    fn signed_reports_are_listed_and_one_that_was_changed_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.html");
        fs::write(&file, "signed").unwrap();
        assert_eq!(signed_reports(folder.path()).unwrap(), (vec![], vec![]));
        let signature = Signature { by: "L. Kern".into(), at: "2026-11-22 04:01".into() };
        let (name, digest) = (file.display().to_string(), sha256(&file).unwrap());
        let (number, letter) = ("1-1".to_owned(), "A".to_owned());
        let revision =
            Revision { number, revision: letter, signature, file: name, sha256: digest, runs: vec![] };
        let (folders, register) = ([folder.path().to_owned()], Register::at(None));
        add_signed(&folders, &register, &revision).unwrap();
        assert_eq!(signed_reports(folder.path()).unwrap(), (vec![revision.clone()], vec![]));
        fs::write(&file, "forged").unwrap();
        let (_, doubts) = signed_reports(folder.path()).unwrap();
        assert!(doubts.len() == 1 && doubts[0].starts_with("signed revision A was changed"), "{doubts:?}");
        assert!(doubts[0].contains("expected SHA-256"), "{doubts:?}");
        fs::remove_file(&file).unwrap();
        let (_, doubts) = signed_reports(folder.path()).unwrap();
        assert!(doubts.len() == 1 && doubts[0].starts_with("signed revision A cannot be read"), "{doubts:?}");
        fs::write(folder.path().join(SIGNED_FILE), "[{").unwrap();
        let other = tempfile::tempdir().unwrap();
        let both = [other.path().to_owned(), folder.path().to_owned()];
        let unwritable = Register::at(Some("/proc/self/none/signatures".into()));
        for (folders, register) in [(&both[..], &register), (&both[..1], &unwritable)] {
            assert!(add_signed(folders, register, &revision).is_err());
            assert_eq!(signed_reports(other.path()).unwrap(), (vec![], vec![]), "in all lists or in none");
        }
        let error = signed_reports(folder.path()).unwrap_err().to_string();
        assert!(error.contains("signed.json is damaged: ") && error.contains("line 1"), "{error}");
    }
}
