//! Name and id of a recording, which the viewer uses to keep two runs apart.

use jiff::{civil::DateTime, tz::TimeZone};
use sha2::{Digest, Sha256};
use std::path::Path;

/// Name and id of a recording.
///
/// The viewer merges files with the same id and keeps files with different ids apart. The id is a hash of the name of
/// the run's folder, so a recording regenerated from the journal is the same recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identity {
    /// The id: unique per run, and always the same for a run.
    pub recording_id: String,
    /// The human-readable name: the name of the run's folder.
    pub name: String,
    /// Start of the run, read from its name (`20261122T040132Z-...`), UTC, nanoseconds since 1970; absent if the name
    /// does not contain it.
    pub began_ns: Option<i64>,
}

impl Identity {
    /// The identity of the run in a folder with this name.
    pub fn of_run(folder_name: &str) -> Self {
        let digest = Sha256::digest(folder_name.as_bytes());
        Self {
            recording_id: hex::encode(&digest[..16]),
            name: folder_name.to_owned(),
            began_ns: began_ns(folder_name),
        }
    }

    /// The identity of the run in this folder.
    pub fn of_folder(folder: &Path) -> Self {
        let whole = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        let name = whole.file_name().map(|name| name.to_string_lossy().into_owned());
        Self::of_run(name.as_deref().unwrap_or("run"))
    }

    /// The identity of the run to which this file (journal or recording) belongs.
    pub fn of_file(file: &Path) -> Self {
        Self::of_folder(file.parent().unwrap_or(Path::new("")))
    }
}

/// The time at the beginning of a run's name, nanoseconds since 1970.
fn began_ns(name: &str) -> Option<i64> {
    let began = DateTime::strptime("%Y%m%dT%H%M%SZ", name.get(..16)?).ok()?.to_zoned(TimeZone::UTC).ok()?;
    began.timestamp().as_nanosecond().try_into().ok()
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

    #[test]
    fn a_run_began_when_its_name_says() {
        let began_s = |name| Identity::of_run(name).began_ns.map(|ns| ns / 1_000_000_000);
        assert_eq!(began_s("19700101T000000Z-demo"), Some(0));
        assert_eq!(began_s("20261122T040132Z-demo-rpf-1"), Some(1_795_320_092));
        assert_eq!(began_s("20280229T235959Z-demo"), Some(1_835_481_599));
        assert_eq!([began_s("demo"), began_s("2026x122T040132Z-demo")], [None, None]);
    }
}
