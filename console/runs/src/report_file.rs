//! The report on a run, as found on disk, and whether it agrees with the journal.

mod figures;

use crate::{budget::Budget, files::REPORT_FILE};
use account::Summary;
use foreign::{plain_json, read_json};
use mission::{Event, EventKind};
use recording::{RECORDING_FILE, journal_of, read_ending, sha256_of};
use report::document::Recovered;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::{
    fs::{self, Metadata},
    io,
    path::Path,
    time::SystemTime,
};

/// A report as written to disk, with the name of the run and the length of the journal from which the report was made.
#[derive(Serialize)]
pub(crate) struct ReportFile<'a> {
    /// Name of the run's folder.
    run: &'a str,
    #[serde(flatten)]
    pub summary: &'a Summary,
    /// Absent if the journal no longer exists.
    pub journal_bytes: Option<u64>,
    /// Absent if the recording no longer exists.
    pub recording_bytes: Option<u64>,
    /// How the run was closed if its writer did not close it.
    #[serde(skip_serializing_if = "Option::is_none")]
    recovered: Option<&'a Recovered>,
    /// SHA-256 of all lines of the file except this one.
    report_sha256: String,
}

impl<'a> ReportFile<'a> {
    /// Formats the report on a run with this name whose files have these lengths in bytes; `recovered` is set if the
    /// writer was killed.
    ///
    /// # Errors
    /// The report cannot be converted to JSON.
    pub(crate) fn text(
        run: &'a str,
        summary: &'a Summary,
        [journal_bytes, recording_bytes]: [Option<u64>; 2],
        recovered: Option<&'a Recovered>,
    ) -> serde_json::Result<String> {
        let report_sha256 = String::new();
        let unsealed = Self { run, summary, journal_bytes, recording_bytes, recovered, report_sha256 };
        let text = |report: &Self| -> serde_json::Result<String> {
            Ok(plain_json(&serde_json::to_string_pretty(report)?).into_owned() + "\n")
        };
        let report_sha256 = digest_of_lines(&text(&unsealed)?);
        text(&Self { report_sha256, ..unsealed })
    }
}

/// SHA-256 of all lines of a report except the line with the digest itself, as computed by `grep -v '"report_sha256"'
/// report.json | sha256sum`.
fn digest_of_lines(text: &str) -> String {
    let lines = text.split_inclusive('\n').filter(|line| !line.contains("\"report_sha256\""));
    sha256_of(lines.collect::<String>().as_bytes())
}

/// The digests and lengths that a report states for the files from which it was made, and related facts.
#[derive(Deserialize)]
struct Source {
    #[serde(default)]
    run: Option<String>,
    events_sha256: Option<String>,
    #[serde(default)]
    journal_bytes: Option<u64>,
    #[serde(default)]
    recording_sha256: Option<String>,
    #[serde(default)]
    recording_bytes: Option<u64>,
    #[serde(default)]
    readings_sha256: Option<String>,
    #[serde(default)]
    recovered: Option<Recovered>,
    #[serde(default)]
    report_sha256: Option<String>,
}

/// Maximum size of a report, bytes: room for a hundred times the missed areas of the largest floor.
const MOST_BYTES: u64 = 8 << 20;

/// Message about a journal other than the journal from which the report was made.
const NOT_THE_ONE: &str = "the report was made from a different journal: the SHA-256 digests differ";

/// Message about a recording that does not belong to the report.
const NOT_THE_RECORDING: &str = "the recording is not the one written with the run: the SHA-256 digests differ; restore the file, or write a new one with `tankops export`";

/// Message about readings that do not belong to the report.
const NOT_THE_READINGS: &str = "readings.parquet is not the file written with the run: the SHA-256 digests differ; restore the file, or write a new one with `tankops export`";

/// Message about a report that has no digest, although every report is written with one.
const NO_SEAL: &str = "report.json was changed after the run ended: its line report_sha256 is missing";

/// How the digest of a recording is obtained.
pub(crate) enum Now<'a> {
    /// Already computed; `None` if the file cannot be read.
    Is(Option<&'a str>),
    /// Computed only if the length and time of the file are not sufficient, as they are in lists.
    Within(&'a Budget),
}

/// The report on a run as found on disk, and where it disagrees with the other files.
pub(crate) struct Reported {
    text: String,
    source: Source,
}

impl Reported {
    /// Reads the report in the folder of a run; `None` if there is none.
    ///
    /// # Errors
    /// The reason why the report cannot be read, as a sentence.
    pub(crate) fn read(folder: &Path) -> Result<Option<Self>, String> {
        match read_json(&folder.join(REPORT_FILE), MOST_BYTES) {
            Ok(text) => {
                let source = serde_json::from_str(&text).map_err(|error| damaged(&error))?;
                Ok(Some(Self { text, source }))
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(format!("{REPORT_FILE} cannot be read: {error}")),
        }
    }

    /// The figures in the report, if the report is unchanged and agrees with the journal.
    ///
    /// # Errors
    /// The reason why the report is not trusted, as a sentence.
    pub(crate) fn summary(&self, folder: &Path, budget: &Budget) -> Result<Box<Summary>, String> {
        let summary: Box<Summary> = serde_json::from_str(&self.text).map_err(|error| damaged(&error))?;
        self.seal_doubt().map_or(Ok(()), Err)?;
        // A report that itself states that the journal is incomplete claims nothing about the journal.
        let Some(then) = &self.source.events_sha256 else { return Ok(summary) };
        let path = journal_of(folder);
        let no_journal = |error: io::Error| format!("{} cannot be read: {error}", name_of(&path));
        let untouched =
            is_untouched(&path, self.source.journal_bytes, &folder.join(REPORT_FILE)).map_err(no_journal)?;
        if !untouched && budget.events_sha256(&path).map_err(no_journal)? != *then {
            return Err(NOT_THE_ONE.to_owned());
        }
        if untouched {
            // Both report and journal are unchanged since they were written together.
            return Ok(summary);
        }
        match read_ending(&path).map_err(no_journal)? {
            Some(ending) if agrees(&summary, &ending) => Ok(summary),
            None if self.recovered().is_some() && summary.outcome.is_none() => Ok(summary),
            _ => Err(format!("{REPORT_FILE} was changed: it ends differently from the journal")),
        }
    }

    /// Name of the run's folder when the run was closed.
    pub(crate) fn closed_as(&self) -> Option<&str> {
        self.source.run.as_deref()
    }

    /// How the run was closed if its writer did not close it.
    pub(crate) fn recovered(&self) -> Option<&Recovered> {
        self.source.recovered.as_ref()
    }

    /// The figures of the report if its writer could not close the run: the report itself states that a file is incomplete.
    /// `None` if the run was closed.
    ///
    /// # Errors
    /// The report was changed, or cannot be read; the reason as a sentence.
    pub(crate) fn unclosed(&self) -> Result<Option<Box<Summary>>, String> {
        let summary: Box<Summary> = serde_json::from_str(&self.text).map_err(|error| damaged(&error))?;
        let is_incomplete = summary.logs.as_ref().is_some_and(|logs| logs.error.is_some());
        if summary.events_sha256.is_some() && !is_incomplete {
            return Ok(None);
        }
        self.seal_doubt().map_or(Ok(Some(summary)), Err)
    }

    /// The digest of the journal from which the report was made.
    pub(crate) fn journal_sha256(&self) -> Option<&str> {
        self.source.events_sha256.as_deref()
    }

    /// Whether the report contains the digests of both journal and recording.
    pub(crate) fn names_digests(&self) -> bool {
        self.source.events_sha256.is_some() && self.source.recording_sha256.is_some()
    }

    /// The reason why the journal with this digest does not match the report; `None` if it does.
    pub(crate) fn journal_doubt(&self, sha256: Option<&str>) -> Option<String> {
        let then = self.source.events_sha256.as_deref()?;
        (then != sha256?).then(|| NOT_THE_ONE.to_owned())
    }

    /// The reason why the recording does not match the report; `None` if it does. A missing recording can be made
    /// again, so it does not count as a mismatch.
    pub(crate) fn recording_doubt(&self, folder: &Path, now: &Now<'_>) -> Option<String> {
        let (then, path) = (self.source.recording_sha256.as_deref()?, folder.join(RECORDING_FILE));
        if !path.exists() {
            return None;
        }
        let budget = match now {
            Now::Is(now) => return (*now != Some(then)).then(|| NOT_THE_RECORDING.to_owned()),
            Now::Within(budget) => budget,
        };
        if is_untouched(&path, self.source.recording_bytes, &folder.join(REPORT_FILE)).unwrap_or(false) {
            return None;
        }
        let length = fs::metadata(&path).map_or(0, |file| file.len());
        if self.source.recording_bytes.is_some_and(|then| then != length) {
            return Some(NOT_THE_RECORDING.to_owned());
        }
        match budget.sha256(&path) {
            Ok(now) if now == then => None,
            Err(error) if error.kind() == io::ErrorKind::QuotaExceeded => {
                Some(format!("{RECORDING_FILE}: {error}"))
            }
            Ok(_) | Err(_) => Some(NOT_THE_RECORDING.to_owned()),
        }
    }

    /// The reason why the file with the readings does not match the report; `None` if it does. A missing file can be made
    /// again, so it does not count as a mismatch.
    pub(crate) fn readings_doubt(&self, sha256: Option<&str>) -> Option<String> {
        let then = self.source.readings_sha256.as_deref()?;
        (then != sha256?).then(|| NOT_THE_READINGS.to_owned())
    }

    /// The reason why the figures are not trusted: they differ from the figures derived from the journal (`figures`),
    /// or the file was changed. `None` if they are trusted.
    pub(crate) fn figures_doubt(&self, figures: &Summary) -> Option<String> {
        if self.source.report_sha256.is_none() {
            return self.seal_doubt();
        }
        // An incomplete journal provides only a few figures.
        let figures = Some(figures).filter(|_| self.source.events_sha256.is_some());
        let reported: Summary = match serde_json::from_str(&self.text) {
            Ok(reported) => reported,
            Err(error) => return Some(damaged(&error)),
        };
        let other = figures.and_then(|figures| figures::difference(reported, figures));
        match (other, self.seal_doubt()) {
            (Some(difference), Some(_)) => Some(format!("{REPORT_FILE} was changed: {difference}")),
            (Some(difference), None) => Some(format!(
                "{REPORT_FILE} does not agree with the journal: {difference}; another version of tankops wrote it, or a person changed it together with its digest"
            )),
            (None, seal) => seal,
        }
    }

    /// The reason why the lines of the report do not match the digest that it contains; `None` if they do.
    fn seal_doubt(&self) -> Option<String> {
        let Some(then) = &self.source.report_sha256 else { return Some(NO_SEAL.to_owned()) };
        let now = digest_of_lines(&self.text);
        (*then != now).then(|| {
            format!(
                "{REPORT_FILE} was changed after the run ended: the SHA-256 of its lines is {now}, expected {then}"
            )
        })
    }
}

fn damaged(error: &serde_json::Error) -> String {
    format!("{REPORT_FILE} is damaged: {error}")
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Whether a file has the length that another file (`stated_in`) states and was last written before that file was; such a
/// file need not be hashed.
///
/// This is sufficient for lists. Where certainty is needed, the file itself is read ([`Reported::journal_doubt`],
/// [`Reported::recording_doubt`]).
pub(crate) fn is_untouched(file: &Path, bytes: Option<u64>, stated_in: &Path) -> io::Result<bool> {
    // If the times are within one tick of the file system's clock, the two files may have been written together, or the
    // file may have been changed afterwards.
    let (file, report) = (fs::metadata(file)?, fs::metadata(stated_in)?);
    let written = |file: &Metadata| file.modified().unwrap_or(SystemTime::UNIX_EPOCH);
    Ok(bytes == Some(file.len()) && written(&file) < written(&report))
}

fn agrees(summary: &Summary, ending: &Event) -> bool {
    let EventKind::Ended { outcome, reason } = &ending.kind else { return false };
    summary.outcome == Some(*outcome)
        && summary.reason.as_ref() == Some(reason)
        && summary.ticks == Some(ending.tick)
}

/// The reason why the journal of a run, whose digest is `sha256`, is not trusted: the report states a different digest,
/// or cannot be read. `None` if the journal is trusted.
pub fn journal_doubt(folder: &Path, sha256: Option<&str>) -> Option<String> {
    match Reported::read(folder) {
        Ok(reported) => reported?.journal_doubt(sha256),
        Err(why) => Some(why),
    }
}

/// The evidence against a journal that has no end: the run has a report, so it was closed normally.
pub fn end_is_missing(folder: &Path) -> Option<String> {
    let reported = Reported::read(folder).ok()??;
    let report: Value = serde_json::from_str(&reported.text).ok()?;
    report.get("outcome")?.as_str()?;
    Some("the run has a report, so it finished, but the end of its journal is missing".to_owned())
}
