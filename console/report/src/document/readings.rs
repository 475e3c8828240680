//! The located readings that a report is about.

use crate::past_run::PastRun;
use serde::Serialize;

/// A readings file, from which a run was located.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Readings {
    /// Name of the run's folder.
    pub run: String,
    /// Name of the readings file.
    pub file: String,
    /// SHA-256 of that file, hexadecimal.
    pub sha256: String,
}

/// The located readings that replace the mission in a report.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Located {
    /// The readings of each run.
    pub readings: Vec<Readings>,
    /// Time from the first to the last reading of a run, seconds, summed over all runs.
    pub time_s: f64,
    /// Time for which the tool was on, seconds, summed over all runs. Absent if the readings of any run do not show
    /// this; no coverage is then stated.
    pub tool_on_s: Option<f64>,
    /// Number of estimated positions.
    pub positions: usize,
}

impl Located {
    /// The located readings of some runs; `None` if the runs were missions.
    pub(super) fn of(past: &[PastRun]) -> Option<Self> {
        let measured = |past: &PastRun| past.fold.run()?.measured.clone();
        let all: Vec<_> = past.iter().map(measured).collect::<Option<_>>()?;
        let of_run = |(past, measured): (&PastRun, &mission::event::Measured)| Readings {
            run: past.name.clone(),
            file: measured.file.clone(),
            sha256: measured.sha256.clone(),
        };
        Some(Self {
            readings: past.iter().zip(&all).map(of_run).collect(),
            time_s: past.iter().filter_map(|past| past.summary.mission_time_s).sum(),
            tool_on_s: all.iter().map(mission::event::Measured::on_for_s).sum(),
            positions: past.iter().map(|past| past.record.track.len()).sum(),
        })
    }

    /// The names of the readings files as text.
    pub(super) fn files(&self) -> String {
        self.readings.iter().map(|readings| readings.file.as_str()).collect::<Vec<_>>().join(", ")
    }
}
