//! What a recording is called, so that the viewer keeps two runs apart.

use sha2::{Digest, Sha256};
use std::path::Path;

/// Name and id of a recording.
///
/// The viewer merges files that carry the same id, and keeps files with different ones apart. The id is a hash of
/// the name of the run's folder, so a recording regenerated from the journal is the same recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identity {
    /// Unique per run, the same every time it is asked for.
    pub recording_id: String,
    /// What people read: the name of the run's folder.
    pub name: String,
}

impl Identity {
    /// The identity of the run in a folder of this name.
    pub fn of_run(folder_name: &str) -> Self {
        let digest = Sha256::digest(folder_name.as_bytes());
        Self { recording_id: hexadecimal(&digest[..16]), name: folder_name.to_owned() }
    }

    /// The identity of the run that this folder holds.
    pub fn of_folder(folder: &Path) -> Self {
        let whole = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        let name = whole.file_name().map(|name| name.to_string_lossy().into_owned());
        Self::of_run(name.as_deref().unwrap_or("run"))
    }

    /// The identity of the run that this file (journal or recording) belongs to.
    pub fn of_file(file: &Path) -> Self {
        Self::of_folder(file.parent().unwrap_or(Path::new("")))
    }
}

/// Bytes as lower-case hexadecimal digits.
pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::with_capacity(2 * bytes.len()), |text, byte| text + &format!("{byte:02x}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_runs_have_equal_ids_and_different_runs_different_ones() {
        let run = Identity::of_run("2026-01-02T03-04-05Z-demo-apf-1");
        assert_eq!(run, Identity::of_file(Path::new("logs/2026-01-02T03-04-05Z-demo-apf-1/events.jsonl")));
        assert_ne!(run.recording_id, Identity::of_run("2026-01-02T03-04-05Z-demo-apf-2").recording_id);
        assert_eq!(run.recording_id.len(), 32);
    }
}
