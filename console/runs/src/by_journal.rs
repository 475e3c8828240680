//! Finds past runs by the digests of their journals.

use crate::{error::RunError, folder::past_runs, report_file::Reported};
use recording::{events_sha256, journal_of};
use std::{cell::OnceCell, path::Path};

/// The names of the runs whose journals have these SHA-256 digests (hexadecimal), in the order of the digests.
///
/// Only journals whose digest is not in a report are read, each at most once. `goes_on` is asked before each of them; the
/// result is `None` if it refuses.
///
/// # Errors
/// The folder cannot be read, or a run is not in it.
pub fn by_journal(
    sha256: &[String],
    logs: &Path,
    goes_on: impl Fn() -> bool,
) -> Result<Option<Vec<String>>, RunError> {
    let folders = past_runs(logs)?;
    let stated: Vec<Option<String>> = folders.iter().map(|folder| stated(folder)).collect();
    let read: Vec<OnceCell<Option<String>>> = vec![OnceCell::new(); folders.len()];
    let digest_of = |index: usize| {
        let digest = || events_sha256(&journal_of(&folders[index])).ok();
        read[index].get_or_init(|| goes_on().then(digest).flatten()).as_ref()
    };
    let find = |wanted: &String| {
        let reported = stated.iter().position(|sha256| sha256.as_ref() == Some(wanted));
        let unreported = || {
            let mut unknown = (0..folders.len()).rev().filter(|index| stated[*index].is_none());
            unknown.find(|index| digest_of(*index) == Some(wanted))
        };
        let found = reported.or_else(unreported).map(|index| name(&folders[index]));
        found.ok_or_else(|| {
            let digest: String = wanted.chars().take(12).collect();
            RunError::Refused(format!(
                "the run with journal {digest}... is not in {}; move its folder there",
                logs.display()
            ))
        })
    };
    let found: Result<Vec<String>, RunError> = sha256.iter().map(find).collect();
    // What a reader that was given up did not find may be there.
    if goes_on() { found.map(Some) } else { Ok(None) }
}

/// The digest of the journal according to the report of the run.
fn stated(folder: &Path) -> Option<String> {
    Reported::read(folder).ok()??.journal_sha256().map(str::to_owned)
}

fn name(folder: &Path) -> String {
    folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use recording::{PLAIN_JOURNAL_FILE, sha256_of};
    use std::fs;

    #[test]
    fn a_run_is_found_by_its_report_or_else_by_its_journal() {
        let place = tempfile::tempdir().unwrap();
        let write = |run: &str, file: &str, text: &str| {
            let folder = place.path().join(run);
            fs::create_dir_all(&folder).unwrap();
            fs::write(folder.join(file), text).unwrap();
        };
        write("20261122T030000Z-killed", PLAIN_JOURNAL_FILE, "{}\n");
        write("20261122T040000Z-closed", "report.json", "{\"events_sha256\":\"c10\"}");
        let killed = sha256_of(b"{}\n");
        let found = by_journal(&["c10".into(), killed], place.path(), || true).unwrap().unwrap();
        assert_eq!(found, ["20261122T040000Z-closed", "20261122T030000Z-killed"]);
        let why = by_journal(&["0123456789abcdef".into()], place.path(), || true).unwrap_err().to_string();
        assert!(why.contains("the run with journal 0123456789ab... is not in"), "{why}");
        let given_up = by_journal(&["0123456789abcdef".into()], place.path(), || false).unwrap();
        assert_eq!(given_up, None, "not an error: it was not looked for");
    }
}
