//! Past runs, read from their journals.

use account::{Expect, Inspection, Summary};
use flight::failure::bad_input;
use report::{
    Document, Merged, PastRun,
    document::{Context, html},
    human, merged,
};
use runs::{Past, by_journal, find, signed_list};
use scenario::Scenario;
use std::path::{Path, PathBuf};

/// Past runs named by the user: folders, or names in the folder of the runs.
///
/// # Errors
/// A run does not exist, or its journal cannot be read.
pub fn read_all(runs: &[PathBuf], logs: &Path) -> anyhow::Result<Vec<Past>> {
    runs.iter().map(|run| Ok(Past::read(&find(run, logs)?)?)).collect()
}

/// The combined scan of several runs on one floor. `goes_on` is asked before each journal is read and before the runs are
/// combined; the result is `None` if it refuses.
///
/// # Errors
/// A run does not exist, its journal cannot be read, or the runs are not on one floor.
pub fn combined(runs: &[String], logs: &Path, goes_on: impl Fn() -> bool) -> anyhow::Result<Option<Merged>> {
    let mut past: Vec<PastRun> = Vec::with_capacity(runs.len());
    for run in runs {
        if !goes_on() {
            return Ok(None);
        }
        past.push(Past::read(&find(run.as_ref(), logs)?)?.run);
    }
    if goes_on() { merged(&past).map(Some).map_err(bad_input) } else { Ok(None) }
}

/// The names of the runs that a re-scan continues, oldest first, from the scenario of the re-scan; empty for any other
/// scenario. `goes_on` is asked before a journal is read; the result is `None` if it refuses.
///
/// # Errors
/// The scenario is not TOML, or a run is not in the folder of the runs.
pub fn continued(
    scenario_toml: &str,
    logs: &Path,
    goes_on: impl Fn() -> bool,
) -> anyhow::Result<Option<Vec<String>>> {
    let digests = report::continued(scenario_toml).map_err(bad_input)?;
    Ok(if digests.is_empty() { Some(Vec::new()) } else { by_journal(&digests, logs, goes_on)? })
}

/// The human-readable report of the run in a folder.
///
/// # Errors
/// Its journal cannot be read.
pub fn report_text(folder: &Path) -> anyhow::Result<String> {
    text_of(&Past::read(folder)?)
}

/// The human-readable report of a run that has already been read.
///
/// # Errors
/// The scenario in its journal is refused.
pub fn text_of(past: &Past) -> anyhow::Result<String> {
    let recovered = past.run.files.recovered.as_ref();
    let recovered = recovered.map(|recovered| format!("{:<16} {recovered}\n", "recovered"));
    Ok(human(&summary(past)?) + &recovered.unwrap_or_default())
}

/// The draft inspection report of the run in a folder, as a page.
///
/// # Errors
/// Its journal, or the list of signed reports on it, cannot be read.
pub fn report_page(folder: &Path) -> anyhow::Result<String> {
    let past = Past::read(folder)?;
    let (inspection, revisions) = (inspection(&past)?, signed_list(folder)?);
    let version = env!("CARGO_PKG_VERSION");
    let context = Context { inspection, revisions, version, ..Context::default() };
    Ok(html(&Document::new(&[past.run], context).map_err(bad_input)?))
}

/// The facts for the inspection report that only people know, from the scenario of a run.
///
/// # Errors
/// The scenario in its journal is refused.
pub fn inspection(Past { opened, .. }: &Past) -> anyhow::Result<Inspection> {
    let scenario = Scenario::recorded(&opened.scenario_toml, "the scenario in the journal");
    Ok(scenario.map_err(|errors| bad_input(errors.render()))?.inspection)
}

/// The summary of a run that has been read, compared with the bounds of its scenario.
///
/// # Errors
/// The scenario in its journal is refused.
pub fn summary(Past { opened, run, .. }: &Past) -> anyhow::Result<Summary> {
    let scenario = Scenario::recorded(&opened.scenario_toml, "the scenario in the journal");
    let scenario = scenario.map_err(|errors| bad_input(errors.render()))?;
    // Bounds apply to missions; located readings are not a mission.
    let expect = if opened.measured.is_some() { Expect::default() } else { scenario.expect };
    let (logs, files) = (Some(run.logs.clone()), &run.files);
    let (events_sha256, recording_sha256) = (files.journal_sha256.clone(), files.recording_sha256.clone());
    let readings_sha256 = files.readings_sha256.clone();
    let summary = run.summary.clone();
    Ok(expect.evaluated(Summary { logs, events_sha256, recording_sha256, readings_sha256, ..summary }))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn runs_that_are_not_wanted_any_more_are_not_read() {
        let runs = ["a".to_owned(), "b".to_owned()];
        let nowhere = Path::new("not-a-folder");
        assert!(combined(&runs, nowhere, || true).is_err(), "they would be read");
        assert_eq!(combined(&runs, nowhere, || false).unwrap(), None);
    }
}
