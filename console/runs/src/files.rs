//! The files of a run, and the names of runs.

use jiff::{Timestamp, civil::DateTime, tz::TimeZone};
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

/// The time at the beginning of the name of a run; `None` if the name does not begin with a time.
pub fn began(run: &str) -> Option<SystemTime> {
    let time = DateTime::strptime("%Y%m%dT%H%M%SZ", run.get(..16)?).ok()?;
    Some(time.to_zoned(TimeZone::UTC).ok()?.timestamp().into())
}

/// A time without its year, such as `22 Nov 04:01`.
pub fn utc_day_minute(moment: SystemTime) -> String {
    let time = Timestamp::try_from(moment.max(SystemTime::UNIX_EPOCH)).unwrap_or(Timestamp::MAX);
    time.strftime("%d %b %H:%M").to_string()
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn the_name_of_a_run_says_when_it_began() {
        let moment = SystemTime::UNIX_EPOCH + Duration::from_secs(1_795_320_049);
        let name = format!("{}-cover-circle-42", utc(moment));
        assert_eq!((began(&name), began("logs")), (Some(moment), None));
        assert_eq!(utc_day_minute(moment), "22 Nov 04:00");
    }
}
