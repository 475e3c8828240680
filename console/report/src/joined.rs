//! Several runs on one floor, combined into one.

use crate::{identity::require_one_floor, past_run::PastRun};
use account::{Account, Evidence, Scanned, account, updated_floor};
use mission::{TaskConfig, event::RunOpened};
use std::borrow::Cow;

/// The combined scan of several runs on one floor.
pub(crate) struct Joined<'a> {
    /// The last run, as it was opened.
    pub(crate) run: &'a RunOpened,
    pub(crate) scanned: Cow<'a, Scanned>,
    pub(crate) evidence: Cow<'a, Evidence>,
}

impl Joined<'_> {
    /// The account of the floor over all of the runs. Floor that counts as scanned in any run counts here, so the
    /// largest position error limit of the runs applies to the whole account.
    pub(crate) fn account(&self, runs: &[PastRun]) -> Account {
        let limits = runs.iter().filter_map(|past| Some(past.fold.run()?.mission.scan_limit_m()));
        let position_limit_m = limits.fold(0.0, f64::max);
        Account { position_limit_m, ..account(self.run, &self.scanned, &self.evidence) }
    }
}

/// Refuses a run whose task was not to scan the floor: it has no missed floor.
pub(crate) fn require_scans(runs: &[PastRun]) -> Result<(), String> {
    let Some(other) = runs.iter().find(|past| !past.fold.has_floor_to_scan()) else { return Ok(()) };
    let task = match other.fold.run().map(|run| &run.mission.task) {
        Some(TaskConfig::Follow { .. }) => "its task is to follow a preset path",
        Some(TaskConfig::Goto { .. }) => "its task is to reach a goal",
        Some(TaskConfig::Survey { .. }) => "its task is to make a map of the floor",
        _ => "its journal contains no task",
    };
    Err(format!("run {} scans no floor: {task}", other.name))
}

/// Combines the scans of several runs, on the floor with the obstacles found by any of them.
///
/// # Errors
/// There is no run, a run is given twice, a run was not a scan, or the runs are on different floors.
pub(crate) fn joined(runs: &[PastRun]) -> Result<Joined<'_>, String> {
    match runs.iter().find(|past| past.is_located()) {
        Some(past) => Err(format!(
            "run {} scans no floor: it consists of located readings; report it with -o FILE",
            past.name
        )),
        None => joined_or_located(runs),
    }
}

/// Like [`joined`], but also accepts runs that were all located from readings.
pub(crate) fn joined_or_located(runs: &[PastRun]) -> Result<Joined<'_>, String> {
    require_one_kind(runs)?;
    let (last, before) = runs.split_last().ok_or("no run to report")?;
    if let Some(other) = runs.iter().find(|past| !before.is_empty() && !past.fold.has_floor_to_scan()) {
        return Err(format!("run {} was not a scan; make a separate report for it", other.name));
    }
    let mut all = alone(last)?;
    require_different(runs)?;
    require_one_floor(runs)?;
    if !before.is_empty() {
        all.evidence.to_mut().name_found(|name| found_name(name, before.len(), runs.len()));
    }
    let closing = |evidence: &Evidence| evidence.found().count() + evidence.no_go().count();
    let own = closing(&all.evidence);
    for (index, past) in before.iter().enumerate() {
        let other = alone(past)?;
        require_aligned((&past.name, &other), (&last.name, &all))?;
        all.scanned.to_mut().join(&other.scanned);
        let mut evidence = other.evidence.into_owned();
        evidence.name_found(|name| found_name(name, index, runs.len()));
        all.evidence.to_mut().join(&evidence);
    }
    if closing(&all.evidence) > own {
        // Floor that is blocked by an obstacle found, or in a zone drawn, in another run is excluded, too. Each run numbers
        // the obstacles that it finds from the same id on, so equal ids do not mean the same obstacle.
        let grid = all.scanned.believed().floor();
        let updated = updated_floor(all.run, grid, &all.evidence, all.run.mission.swath_m);
        let changes = updated.into_floor().kinds();
        all.scanned.to_mut().change(&changes);
    }
    Ok(all)
}

/// Refuses a run that is given twice, under one name or two.
fn require_different(runs: &[PastRun]) -> Result<(), String> {
    for (index, past) in runs.iter().enumerate() {
        let others = &runs[index + 1..];
        if let Some(other) = others.iter().find(|other| other.name == past.name) {
            return Err(format!("run {} is given twice", other.name));
        }
        let digest = &past.files.journal_sha256;
        let is_copy = |other: &&PastRun| digest.is_some() && other.files.journal_sha256 == *digest;
        if let Some(other) = others.iter().find(is_copy) {
            return Err(format!(
                "runs {} and {} have the same journal: one is a copy of the other, or both ran the same \
                 mission with the same seed",
                past.name, other.name
            ));
        }
    }
    Ok(())
}

/// The name of an object found in one of several runs; each run numbers its objects from 1.
pub(crate) fn found_name(name: &str, run: usize, runs: usize) -> String {
    if runs > 1 { format!("{name} of run {}", run + 1) } else { name.to_owned() }
}

/// Computes what one run scanned.
fn alone(past: &PastRun) -> Result<Joined<'_>, String> {
    let PastRun { name, fold, .. } = past;
    // A survey drives without its tool.
    let nothing = |run: &RunOpened| {
        let mission = &run.mission;
        mission
            .task
            .is_survey()
            .then(|| Cow::Owned(Scanned::new(run.floor.clone(), mission.tool(), mission.start)))
    };
    let scanned = |run| fold.scanned().map(Cow::Borrowed).or_else(|| nothing(run));
    let found = fold.run().and_then(|run| Some((scanned(run)?, fold.evidence()?, run)));
    found
        .map(|(scanned, evidence, run)| Joined { run, scanned, evidence: Cow::Borrowed(evidence) })
        .ok_or_else(|| format!("run {name} scans no floor: its task is to reach a goal"))
}

/// Refuses a mix of missions and located readings.
fn require_one_kind(runs: &[PastRun]) -> Result<(), String> {
    let located = runs.iter().find(|past| past.is_located());
    match located.zip(runs.iter().find(|past| !past.is_located())) {
        Some((located, flown)) => Err(format!(
            "run {} consists of located readings, and run {} is a mission; report them separately",
            located.name, flown.name
        )),
        None => Ok(()),
    }
}

/// Refuses runs whose cell grids differ.
fn require_aligned(
    (name, other): (&str, &Joined<'_>),
    (last_name, all): (&str, &Joined<'_>),
) -> Result<(), String> {
    if all.scanned.believed().floor().is_aligned_with(other.scanned.believed().floor()) {
        return Ok(());
    }
    Err(format!("runs {name} and {last_name} have different cells; run both with the same mission.cell_m"))
}
