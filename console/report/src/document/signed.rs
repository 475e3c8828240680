//! Signatures, and the signed reports on a run.

use super::run_part::Files;
use crate::past_run::PastRun;
use serde::{Deserialize, Serialize};

/// A report that was signed earlier; it is never changed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Revision {
    /// The document number.
    #[serde(default)]
    pub number: String,
    /// The letter of the revision.
    pub revision: String,
    /// The signer, and the time of signing.
    #[serde(flatten)]
    pub signature: Signature,
    /// The name of the report file.
    pub file: String,
    /// SHA-256 of the report file, hexadecimal.
    pub sha256: String,
    /// The runs that the report covers.
    #[serde(default)]
    pub runs: Vec<SignedRun>,
}

impl Revision {
    /// Checks a run against the signed runs of the same name; returns the first mismatch as a sentence.
    pub fn doubt(&self, now: &SignedRun) -> Option<String> {
        let then = self.runs.iter().find(|then| then.run == now.run && *then != now)?;
        let (file, then, now) = if then.journal_sha256 == now.journal_sha256 {
            ("recording", &then.recording_sha256, &now.recording_sha256)
        } else {
            ("journal", &then.journal_sha256, &now.journal_sha256)
        };
        let digest = |sha256: &Option<String>| sha256.clone().unwrap_or_else(|| "none".into());
        Some(format!(
            "signed revision {} covers a different {file}: expected SHA-256 {}, found {}",
            self.revision,
            digest(then),
            digest(now)
        ))
    }
}

/// The state of a run when a report on it was signed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SignedRun {
    /// Name of the run's folder when the run was closed.
    pub run: String,
    /// SHA-256 of the run's journal, hexadecimal.
    pub journal_sha256: Option<String>,
    /// SHA-256 of the run's recording, hexadecimal.
    pub recording_sha256: Option<String>,
}

impl SignedRun {
    /// The current state of a run.
    pub fn of(past: &PastRun) -> Self {
        let Files { journal_sha256, recording_sha256, closed_as, .. } = past.files.clone();
        Self { run: closed_as.unwrap_or_else(|| past.name.clone()), journal_sha256, recording_sha256 }
    }

    /// Returns the run under its current folder name, and under the name that the folder had when the run was closed.
    /// Another run may have taken the earlier name since then.
    pub fn names_of(past: &PastRun) -> [Self; 2] {
        let closed = Self::of(past);
        [Self { run: past.name.clone(), ..closed.clone() }, closed]
    }
}

/// The signer, and the time of signing.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Signature {
    /// Name of the inspector.
    pub by: String,
    /// Time of signing, UTC, as `2026-11-22 04:01`.
    pub at: String,
}
