//! The proof that a run was verified, in a separate file beside the journal. It holds for one journal only, because it
//! states the digest of that journal.

use crate::{budget::Budget, files::utc_minute, report_file::is_untouched, whole::write_whole};
use foreign::read_json;
use recording::journal_of;
use serde::{Deserialize, Serialize};
use std::{fs, path::Path, time::SystemTime};

/// File name of the proof in the folder of a run.
pub const VERIFIED_FILE: &str = "verified.json";
/// Maximum size of the file, bytes.
const MOST_BYTES: u64 = 1 << 16;

/// A journal that was verified.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Proof {
    /// Time at which the verification ended, UTC, such as `2026-11-22 04:01`.
    at: String,
    /// SHA-256 of the journal's events, hexadecimal.
    events_sha256: String,
    /// Length of the journal, bytes.
    journal_bytes: u64,
}

impl Proof {
    /// Reads the journal of the run in a folder before its verification begins, so that a journal that changes meanwhile
    /// does not count as verified.
    ///
    /// # Errors
    /// The journal cannot be read.
    pub fn begin(folder: &Path) -> std::io::Result<Self> {
        let journal = journal_of(folder);
        let journal_bytes = fs::metadata(&journal)?.len();
        let events_sha256 = Budget::of_one_run().events_sha256(&journal)?;
        Ok(Self { at: String::new(), events_sha256, journal_bytes })
    }

    /// Keeps the proof beside the journal.
    ///
    /// # Errors
    /// The system refuses to write the file.
    pub fn keep(self, folder: &Path, now: SystemTime) -> std::io::Result<()> {
        let proof = Self { at: utc_minute(now), ..self };
        let text = serde_json::to_string_pretty(&proof)? + "\n";
        write_whole(&folder.join(VERIFIED_FILE), text.as_bytes())
    }
}

/// The time at which the run in a folder was verified; `None` if it was not, or if its journal has changed since.
pub(crate) fn verified(folder: &Path, budget: &Budget) -> Option<String> {
    let (path, journal) = (folder.join(VERIFIED_FILE), journal_of(folder));
    let proof: Proof = serde_json::from_str(&read_json(&path, MOST_BYTES).ok()?).ok()?;
    let is_same = is_untouched(&journal, Some(proof.journal_bytes), &path).ok()?
        || budget.events_sha256(&journal).ok()? == proof.events_sha256;
    is_same.then_some(proof.at)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use recording::JOURNAL_FILE;
    use std::time::Duration;

    #[test]
    fn a_proof_holds_only_for_the_journal_that_was_verified() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let journal = folder.join(JOURNAL_FILE);
        let compressed = |text: &str| zstd::encode_all(text.as_bytes(), 1).unwrap();
        fs::write(&journal, compressed("one\n")).unwrap();
        let seen = || verified(folder, &Budget::of_a_list());
        assert_eq!(seen(), None, "not verified");
        let proof = Proof::begin(folder).unwrap();
        proof.keep(folder, SystemTime::UNIX_EPOCH + Duration::from_mins(1)).unwrap();
        assert_eq!(seen().as_deref(), Some("1970-01-01 00:01"));

        fs::write(&journal, compressed("one\n")).unwrap();
        assert!(seen().is_some(), "the same journal, restored from a copy");
        fs::write(&journal, compressed("two\n")).unwrap();
        assert_eq!(seen(), None, "another journal");
        fs::write(folder.join(VERIFIED_FILE), "[]").unwrap();
        assert_eq!(seen(), None, "damaged");
    }
}
