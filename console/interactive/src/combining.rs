//! Combines a re-scan with the runs that it continues.

use mission::{Event, EventKind};
use recording::{JournalReader, journal_of};
use std::path::Path;
use tui::{
    RunMsg,
    model::{Combination, Continued},
};
use world::Point;

/// The runs that a scenario continues, and where the last of them left the robot; `None` if it continues none.
///
/// # Errors
/// Why the runs cannot be found, as a sentence.
pub(super) fn before(scenario_toml: &str, logs: &Path) -> Result<Option<Continued>, String> {
    let runs = review::continued(scenario_toml, logs, || true).map_err(|error| format!("{error:#}"))?;
    let runs = runs.unwrap_or_default();
    let left_at = runs.last().map(|last| left_at(last, logs));
    Ok(left_at.map(|left_at| Continued { runs, left_at }))
}

/// Tells the screen which runs a scenario continues, then the floor that they have scanned; `send` returns whether the
/// screen still listens.
pub(super) fn look_back(scenario_toml: &str, logs: &Path, send: impl Fn(RunMsg) -> bool) {
    let Some(found) = before(scenario_toml, logs).transpose() else { return };
    let runs = found.as_ref().map_or_else(|_| Vec::new(), |continued| continued.runs.clone());
    if !send(RunMsg::Continues(found)) || runs.is_empty() {
        return;
    }
    if let Some(found) = scanned_before(&runs, logs, || true).transpose() {
        send(RunMsg::ScannedBefore(found.map(Box::new)));
    }
}

/// The same for a past run.
pub(super) fn look_back_from(run: &str, logs: &Path, send: impl Fn(RunMsg) -> bool) {
    // The replay itself reports a run that cannot be read.
    let Ok(folder) = runs::find(run.as_ref(), logs) else { return };
    let Ok(mut events) = JournalReader::open(&journal_of(&folder)) else { return };
    if let Some(Ok(Event { kind: EventKind::RunOpened(opened), .. })) = events.next() {
        look_back(&opened.scenario_toml, logs, send);
    }
}

/// The last estimated position of a past run; the part of a journal before the damage counts.
fn left_at(run: &str, logs: &Path) -> Option<Point> {
    let folder = runs::find(run.as_ref(), logs).ok()?;
    let events = JournalReader::open(&journal_of(&folder)).ok()?.map_while(Result::ok);
    let places = events.filter_map(|event| match event.kind {
        EventKind::Estimated { pose, .. } => Some(pose.position),
        _ => None,
    });
    places.last()
}

/// The combined scan of the runs that a re-scan continues, without the re-scan; `None` if `goes_on` refuses.
///
/// # Errors
/// Why the runs cannot be combined, as a sentence.
pub(super) fn scanned_before(
    runs: &[String],
    logs: &Path,
    goes_on: impl Fn() -> bool,
) -> Result<Option<Combination>, String> {
    let found = combined(runs, logs, goes_on)?;
    Ok(found.map(|found| Combination { earlier: runs.to_owned(), ..found }))
}

/// The combined scan of runs, the last of which is the re-scan; `None` if `goes_on` refuses.
///
/// # Errors
/// Why the runs cannot be combined, as a sentence.
pub(super) fn combined(
    runs: &[String],
    logs: &Path,
    goes_on: impl Fn() -> bool,
) -> Result<Option<Combination>, String> {
    let earlier = runs.split_last().map_or_else(Vec::new, |(_, earlier)| earlier.to_vec());
    let merged = review::combined(runs, logs, goes_on).map_err(|error| format!("{error:#}"))?;
    Ok(merged.map(|merged| Combination {
        earlier,
        floor: merged.floor,
        kinds: merged.kinds,
        taken_back: merged.coverage.taken_back,
        scanned: merged.scanned,
        not_requested: merged.not_requested,
    }))
}

/// The combined scan of a past run and the runs that its scenario continues; `None` if it continues none, or if `goes_on`
/// refuses.
///
/// # Errors
/// Why the runs cannot be found or combined, as a sentence.
pub(super) fn of_rescan(
    run: &str,
    scenario_toml: &str,
    logs: &Path,
    goes_on: impl Fn() -> bool,
) -> Result<Option<Combination>, String> {
    let earlier = review::continued(scenario_toml, logs, &goes_on).map_err(|error| format!("{error:#}"))?;
    let Some(earlier) = earlier.filter(|earlier| !earlier.is_empty()) else { return Ok(None) };
    let runs: Vec<String> = earlier.into_iter().chain([run.to_owned()]).collect();
    combined(&runs, logs, goes_on)
}
