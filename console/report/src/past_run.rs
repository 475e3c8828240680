//! A past run in the form in which reports use it.

use crate::{document::Files, record::Record};
use account::{Fold, Imported, Judge, Logs, Silence, Summary};
use mission::Sampling;
use serde::{Deserialize, Serialize};

/// A past run: its name, its files and their contents.
#[derive(Debug)]
pub struct PastRun {
    /// Name of the run's folder.
    pub name: String,
    /// The files of the run.
    pub logs: Logs,
    /// Start time, UTC, as `2026-11-22 04:01`, if the folder name contains it.
    pub began: Option<String>,
    /// Digests and lengths of the run's files.
    pub files: Files,
    /// The events of the run, folded.
    pub fold: Fold,
    /// The figures of the run, computed from the events, with the account of the floor.
    pub summary: Summary,
    /// The record of the run over time and place.
    pub record: Record,
    /// Readings of a real instrument that were imported, and where they are from.
    pub imported: Option<Box<(ImportedReadings, Imported)>>,
}

/// A file of readings that was imported into a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImportedReadings {
    /// Name of the file.
    pub file: String,
    /// SHA-256 of the file, hexadecimal.
    pub file_sha256: String,
    /// SHA-256 of the placed readings, `readings.parquet`, hexadecimal.
    pub readings_sha256: String,
    /// The program that imported the file.
    pub by: String,
    /// The times in which channels gave no readings; absent in files of older versions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub silences: Vec<Silence>,
    /// What was found in the file, as sentences.
    pub notes: Vec<String>,
}

impl PastRun {
    /// That the run was cut off, and who closed it; `None` if it reached its end or was not closed.
    pub fn cut_off(&self) -> Option<String> {
        let recovered = self.files.recovered.as_ref().filter(|_| self.summary.outcome.is_none())?;
        Some(format!("it was cut off, and later closed {recovered}"))
    }

    /// Whether the run consists of located readings and is not a mission.
    pub(crate) fn is_located(&self) -> bool {
        self.fold.run().is_some_and(|run| run.measured.is_some())
    }

    /// The readings of the instrument, simulated or imported, and how it reads; `None` without readings.
    pub(crate) fn readings(&self) -> Option<(&Judge, Sampling)> {
        let simulated = || self.fold.survey().map(|survey| (survey.judge(), survey.sampling()));
        let imported = self.imported.as_ref().map(|of| (of.1.judge(), of.1.sampling()));
        imported.or_else(simulated)
    }
}
