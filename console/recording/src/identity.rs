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
    /// When the run began by its name (`20261122T040132Z-...`), UTC, nanoseconds since 1970; absent if that does not say.
    pub began_ns: Option<i64>,
}

impl Identity {
    /// The identity of the run in a folder of this name.
    pub fn of_run(folder_name: &str) -> Self {
        let digest = Sha256::digest(folder_name.as_bytes());
        Self {
            recording_id: hexadecimal(&digest[..16]),
            name: folder_name.to_owned(),
            began_ns: began_ns(folder_name),
        }
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

/// The time with which a name begins, nanoseconds since 1970.
fn began_ns(name: &str) -> Option<i64> {
    let stamp = name.get(..16).filter(|stamp| stamp.as_bytes()[8] == b'T' && stamp.ends_with('Z'))?;
    let number = |digits: std::ops::Range<usize>| -> Option<i64> {
        stamp.get(digits).filter(|digits| digits.bytes().all(|b| b.is_ascii_digit()))?.parse().ok()
    };
    let (year, month, day) = (number(0..4)?, number(4..6)?, number(6..8)?);
    // Years begin in March, so that the leap day is the last one.
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let days = 365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day - 1 - 719_468;
    let seconds = 3600 * number(9..11)? + 60 * number(11..13)? + number(13..15)?;
    Some((86_400 * days + seconds) * 1_000_000_000)
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

    #[test]
    fn a_run_began_when_its_name_says() {
        let began_s = |name| Identity::of_run(name).began_ns.map(|ns| ns / 1_000_000_000);
        assert_eq!(began_s("19700101T000000Z-demo"), Some(0));
        assert_eq!(began_s("20261122T040132Z-demo-rpf-1"), Some(1_795_320_092));
        assert_eq!(began_s("20280229T235959Z-demo"), Some(1_835_481_599));
        assert_eq!([began_s("demo"), began_s("2026x122T040132Z-demo")], [None, None]);
    }
}
