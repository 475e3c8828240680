//! The report of a run on disk, and whether it fits the journal.

use crate::files::REPORT_FILE;
use mission::{Event, EventKind};
use recording::{RECORDING_FILE, events_sha256, journal_of, read_ending, sha256, sha256_of};
use report::Summary;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::{
    collections::BTreeSet,
    fs::{self, Metadata},
    io,
    path::Path,
    time::SystemTime,
};

/// A report as it is written to disk: with the length of the journal that it was made from.
#[derive(Serialize)]
pub(crate) struct ReportFile<'a> {
    #[serde(flatten)]
    pub summary: &'a Summary,
    /// Absent if there is no journal any more.
    pub journal_bytes: Option<u64>,
    /// Absent if there is no recording any more.
    pub recording_bytes: Option<u64>,
    /// SHA-256 of all other lines of the file.
    report_sha256: String,
}

impl<'a> ReportFile<'a> {
    /// The report on files of these lengths, bytes, as text.
    ///
    /// # Errors
    /// It cannot be written as JSON.
    pub(crate) fn text(
        summary: &'a Summary,
        journal_bytes: Option<u64>,
        recording_bytes: Option<u64>,
    ) -> serde_json::Result<String> {
        let unsealed = Self { summary, journal_bytes, recording_bytes, report_sha256: String::new() };
        let text = serde_json::to_string_pretty(&unsealed)? + "\n";
        let report_sha256 = digest_of_lines(&text);
        Ok(serde_json::to_string_pretty(&Self { report_sha256, ..unsealed })? + "\n")
    }
}

/// SHA-256 of all lines of a report but that with the digest itself: `grep -v '"report_sha256"' report.json | sha256sum`.
fn digest_of_lines(text: &str) -> String {
    let lines = text.split_inclusive('\n').filter(|line| !line.contains("\"report_sha256\""));
    sha256_of(lines.collect::<String>().as_bytes())
}

/// What a report says of the files that it was made from.
#[derive(Deserialize)]
struct Source {
    events_sha256: Option<String>,
    #[serde(default)]
    journal_bytes: Option<u64>,
    #[serde(default)]
    recording_sha256: Option<String>,
    #[serde(default)]
    recording_bytes: Option<u64>,
    #[serde(default)]
    report_sha256: Option<String>,
}

/// The report, if it can be read and fits the journal.
pub(crate) fn read_report(folder: &Path, text: &str) -> Result<Box<Summary>, String> {
    let damaged = |error: serde_json::Error| format!("{REPORT_FILE} is damaged: {error}");
    let report = serde_json::from_str(text).map(recording::with_todays_names).map_err(damaged)?;
    let summary: Summary = serde_json::from_value(report).map_err(damaged)?;
    let source: Source = serde_json::from_str(text).map_err(damaged)?;
    if let Some(changed) = seal_doubt(text, &source) {
        return Err(changed);
    }
    // A report that says itself that the journal is not whole claims nothing about it.
    let Some(then) = &source.events_sha256 else { return Ok(Box::new(summary)) };
    let path = journal_of(folder);
    let no_journal = |error: io::Error| format!("{} cannot be read: {error}", name_of(&path));
    let untouched = is_untouched(&path, source.journal_bytes, folder).map_err(no_journal)?;
    if !untouched && events_sha256(&path).map_err(no_journal)? != *then {
        return Err(NOT_THE_ONE.to_owned());
    }
    if untouched && source.report_sha256.is_some() {
        // Report and journal are as they were written together.
        return Ok(Box::new(summary));
    }
    match read_ending(&path).map_err(no_journal)? {
        Some(ending) if agrees(&summary, &ending) => Ok(Box::new(summary)),
        _ => Err(format!("{REPORT_FILE} was changed: it does not end as the journal does")),
    }
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// What is said of a journal that its report was not made from.
const NOT_THE_ONE: &str =
    "the journal is not the one that the report was made from: their SHA-256 digests differ";

/// What is said of a recording that its report was not made with.
const NOT_THE_RECORDING: &str = "the recording is not the one that was written with the run: their SHA-256 digests differ; `tankops export` makes it again";

/// What speaks against a report that does not have the digest any more that it was written with.
fn seal_doubt(text: &str, source: &Source) -> Option<String> {
    let (then, now) = (source.report_sha256.as_ref()?, digest_of_lines(text));
    (*then != now).then(|| {
        format!(
            "{REPORT_FILE} was changed after the run ended: its lines have the SHA-256 {now}, expected {then}"
        )
    })
}

/// What speaks against the figures in the report of a run: the journal gives others, or the file was changed. `figures`: those
/// that the journal gives; `None` for a journal of another version, whose figures may be defined otherwise.
pub(crate) fn figures_doubt(folder: &Path, figures: Option<&Summary>) -> Option<String> {
    let text = fs::read_to_string(folder.join(REPORT_FILE)).ok()?;
    let source: Source = serde_json::from_str(&text).ok()?;
    // Older reports have no digest, and some of their figures are defined otherwise; those of a journal that is not whole are few.
    source.report_sha256.as_ref().and(source.events_sha256.as_ref())?;
    let reported: Summary = serde_json::from_str(&text).ok()?;
    let other =
        figures.and_then(|figures| other_figure(reported, figures)).map(|(key, reported, computed)| {
            format!("{REPORT_FILE} was changed: {key} is {reported}, the journal gives {computed}")
        });
    other.or_else(|| seal_doubt(&text, &source))
}

/// The first figure of a report that the journal gives otherwise, with both values. What is no event is not compared.
fn other_figure(reported: Summary, computed: &Summary) -> Option<(String, String, String)> {
    let computed = Summary {
        wall_time_s: reported.wall_time_s,
        violations: reported.violations.clone(),
        planner_calls: reported.planner_calls,
        stops: reported.stops,
        events_sha256: reported.events_sha256.clone(),
        recording_sha256: reported.recording_sha256.clone(),
        logs: reported.logs.clone(),
        ..computed.clone()
    };
    // Through text, as the report went.
    let text = serde_json::to_string(&computed).ok()?;
    let computed = serde_json::to_value(serde_json::from_str::<Summary>(&text).ok()?).ok()?;
    first_difference(String::new(), &serde_json::to_value(reported).ok()?, &computed)
}

/// The first place, as `floor.missed.3.area_m2`, where two values differ, with both as text.
fn first_difference(key: String, one: &Value, other: &Value) -> Option<(String, String, String)> {
    let below = |name: &str| if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
    match (one, other) {
        (one, other) if one == other => None,
        (Value::Object(ones), Value::Object(others)) => {
            let value = |map: &Map<String, Value>, name: &str| map.get(name).cloned().unwrap_or_default();
            let names: BTreeSet<&String> = ones.keys().chain(others.keys()).collect();
            names
                .into_iter()
                .find_map(|name| first_difference(below(name), &value(ones, name), &value(others, name)))
        }
        (Value::Array(ones), Value::Array(others)) if ones.len() == others.len() => {
            let mut pairs = ones.iter().zip(others).enumerate();
            pairs.find_map(|(index, (one, other))| first_difference(below(&index.to_string()), one, other))
        }
        (Value::Array(ones), Value::Array(others)) => {
            Some((key, format!("a list of {}", ones.len()), format!("one of {}", others.len())))
        }
        _ => Some((key, one.to_string(), other.to_string())),
    }
}

/// Whether a file has the length that the report names and was not written after it; then it is not hashed.
///
/// This is for lists; whoever must be sure reads the file ([`journal_doubt`], [`recording_doubt`]).
fn is_untouched(file: &Path, bytes: Option<u64>, folder: &Path) -> io::Result<bool> {
    // In one tick of the file system's clock both may have been written, or the file changed.
    let (file, report) = (fs::metadata(file)?, fs::metadata(folder.join(REPORT_FILE))?);
    let written = |file: &Metadata| file.modified().unwrap_or(SystemTime::UNIX_EPOCH);
    Ok(bytes == Some(file.len()) && written(&file) < written(&report))
}

fn agrees(summary: &Summary, ending: &Event) -> bool {
    let EventKind::Ended { outcome, reason } = &ending.kind else { return false };
    summary.outcome == Some(*outcome)
        && summary.reason.as_ref() == Some(reason)
        && summary.ticks == Some(ending.tick)
}

/// What speaks against the journal of a run whose digest is this: its report names another one, or cannot be read.
pub fn journal_doubt(folder: &Path, sha256: Option<&str>) -> Option<String> {
    let text = match fs::read_to_string(folder.join(REPORT_FILE)) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return None,
        Err(error) => return Some(format!("{REPORT_FILE} cannot be read: {error}")),
    };
    match serde_json::from_str::<Source>(&text) {
        Ok(source) => (source.events_sha256? != sha256?).then(|| NOT_THE_ONE.to_owned()),
        Err(error) => Some(format!("{REPORT_FILE} is damaged: {error}")),
    }
}

/// What contradicts a journal without an end: the run has a report, so it was closed cleanly.
pub fn end_is_missing(folder: &Path) -> Option<String> {
    let report: Value = serde_json::from_str(&fs::read_to_string(folder.join(REPORT_FILE)).ok()?).ok()?;
    report.get("outcome")?.as_str()?;
    Some("the run has a report, so it came to its end, but the journal has none".to_owned())
}

/// What speaks against the recording of a run: it is not the one whose digest its report names. `sha256`: its digest, `None`
/// to look at length and time first, as lists do. A recording that is not there any more can be made again, and is no doubt.
pub fn recording_doubt(folder: &Path, sha256_now: Option<&str>) -> Option<String> {
    let text = fs::read_to_string(folder.join(REPORT_FILE)).ok()?;
    let source: Source = serde_json::from_str(&text).ok()?;
    let (then, path) = (source.recording_sha256?, folder.join(RECORDING_FILE));
    if !path.exists() {
        return None;
    }
    let is_same = match sha256_now {
        Some(now) => now == then,
        None => {
            is_untouched(&path, source.recording_bytes, folder).unwrap_or(false)
                || sha256(&path).is_ok_and(|now| now == then)
        }
    };
    (!is_same).then(|| NOT_THE_RECORDING.to_owned())
}

/// Whether there is a report of the end of a run that names the digests of its files.
pub(crate) fn names_digests(folder: &Path) -> bool {
    let text = fs::read_to_string(folder.join(REPORT_FILE)).ok();
    let source: Option<Source> = text.and_then(|text| serde_json::from_str(&text).ok());
    source.is_some_and(|source| source.events_sha256.is_some() && source.recording_sha256.is_some())
}
