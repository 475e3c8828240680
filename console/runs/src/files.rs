//! The files of a run, and the names of runs.

use jiff::Timestamp;
use std::time::SystemTime;

/// The report on a run that has ended.
pub(crate) const REPORT_FILE: &str = "report.json";
/// Locked while a process writes to the run.
pub(crate) const LOCK_FILE: &str = "run.lock";

/// A time, in the form with which the names of runs begin. A clock before 1970 or after 9999 is treated as the nearest
/// time in that range.
pub fn utc(moment: SystemTime) -> String {
    let time = Timestamp::try_from(moment.max(SystemTime::UNIX_EPOCH)).unwrap_or(Timestamp::MAX);
    time.strftime("%Y%m%dT%H%M%SZ").to_string()
}

/// A time, rounded to the nearest minute, such as `2026-11-22 04:01`.
pub fn utc_minute(moment: SystemTime) -> String {
    let time = Timestamp::try_from(moment.max(SystemTime::UNIX_EPOCH)).unwrap_or(Timestamp::MAX);
    time.strftime("%Y-%m-%d %H:%M").to_string()
}

/// Replaces all characters that a file system or a shell could misinterpret.
pub(crate) fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' }).collect()
}
