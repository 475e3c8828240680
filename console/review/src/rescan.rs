//! A mission that re-scans floor missed by past runs.

use crate::{past::read_all, survey::scan_of_map};
use anyhow::Context;
use flight::failure::bad_input;
use report::{PastRun, Rescan};
use runs::{Past, find};
use scenario::{Continued, Scenario};
use std::path::{Path, PathBuf};

/// Maximum number of boxes in a scenario for a re-scan. If there were more, they are merged into coarser boxes.
const MOST_BOXES: usize = 4000;
/// Area below which missed floor is not worth a mission, square metres.
pub const MIN_AREA_M2: f64 = 0.05;

/// A re-scan of floor missed by past runs.
#[derive(Debug)]
pub enum NextScan {
    /// There is floor to re-scan.
    Worth(Box<MissedScan>),
    /// No missed floor is worth a re-scan. Contains the reason as a sentence, and the areas that remain missed.
    Nothing(String),
}

/// The floor missed by past runs, and the scenario that re-scans it.
#[derive(Debug)]
pub struct MissedScan {
    /// The missed floor.
    pub missed: Rescan,
    /// The scenario as a file.
    pub text: String,
    /// The scenario, read from that text.
    pub scenario: Scenario,
    /// The keys of the run's scenario that describe faults of that run and are left out.
    pub left_out: Vec<String>,
}

/// Builds the scenario that re-scans floor missed by past runs.
///
/// # Errors
/// The runs cannot be combined.
pub fn missed_scan(past: Vec<Past>, min_area_m2: f64, shown_name: &str) -> anyhow::Result<NextScan> {
    let (opened, past): (Vec<_>, Vec<PastRun>) = past.into_iter().map(|past| (past.opened, past.run)).unzip();
    let missed = report::rescan(&past, min_area_m2, MOST_BOXES).map_err(bad_input)?;
    if missed.boxes.is_empty() {
        let why = missed.why_nothing(min_area_m2);
        let out_of_reach = missed.human_out_of_reach();
        let text = format!("{why} (`tankops rescan --min-area-m2` sets the limit)\n{out_of_reach}");
        return Ok(NextScan::Nothing(text.trim_end().to_owned()));
    }
    let runs = past.iter().map(continued).collect::<anyhow::Result<Vec<_>>>()?;
    let last = opened.last().context("no run given")?;
    let drawn: Vec<_> =
        missed.zones.iter().filter(|zone| !last.world.zones.contains(zone)).cloned().collect();
    let text = scenario::rescan(last, &runs, &missed.boxes, &missed.found, &drawn);
    let text = text.context("reading the new scenario")?;
    let scenario = Scenario::parse(&text, shown_name).map_err(|errors| bad_input(errors.render()))?;
    let left_out = scenario::left_out_of_rescan(&last.scenario_toml);
    Ok(NextScan::Worth(Box::new(MissedScan { missed, text, scenario, left_out })))
}

/// The run in the form in which the scenario of its re-scan names it.
fn continued(run: &PastRun) -> anyhow::Result<Continued<'_>> {
    let journal_sha256 = run.files.journal_sha256.as_deref();
    let journal_sha256 =
        journal_sha256.with_context(|| format!("run {}: its journal has no digest", run.name))?;
    Ok(Continued { name: &run.name, journal_sha256, ended_s: run.summary.mission_time_s.unwrap_or(0.0) })
}

/// The next scan after some runs, for the console: a re-scan of the floor that they missed or, after a survey, a scan of
/// the floor that it mapped.
///
/// # Errors
/// See [`missed_scan`]. Other causes: a journal was changed, no floor is left to re-scan, or a survey has no map.
pub fn rescan_of(runs: &[String], logs: &Path) -> anyhow::Result<Scenario> {
    if let [run] = runs
        && let Some(scan) = scan_of_map(&find(Path::new(run), logs)?)?
    {
        return Ok(scan);
    }
    let runs: Vec<PathBuf> = runs.iter().map(PathBuf::from).collect();
    let past = read_all(&runs, logs)?;
    past.iter().map(doubt).collect::<anyhow::Result<Vec<_>>>()?;
    let shown_name = format!("the re-scan of {}", past.last().map_or("", |past| past.run.name.as_str()));
    match missed_scan(past, MIN_AREA_M2, &shown_name)? {
        NextScan::Worth(scan) => Ok(scan.scenario),
        NextScan::Nothing(why) => Err(bad_input(why)),
    }
}

/// The doubts about a journal, as notes.
///
/// # Errors
/// It names scanned cells outside the floor.
pub fn doubt(Past { opened, run, beyond_floor }: &Past) -> anyhow::Result<Option<String>> {
    if let Some(tick) = beyond_floor {
        let cells = opened.floor.len();
        return Err(bad_input(format!(
            "run {}: its journal was changed: an event of tick {tick} names a cell beyond the {cells} cells \
             of the floor",
            run.name
        )));
    }
    let doubt = run.logs.error.as_ref().map(|doubt| format!("note: run {}: {doubt}", run.name));
    let is_open = run.summary.outcome.is_none() && run.files.are_as_reported.is_none();
    let killed = (is_open && !run.logs.is_open).then(|| {
        format!(
            "note: run {name} was killed; to make it part of a signed report, close it with `tankops \
             recover {name} --by NAME`",
            name = run.name
        )
    });
    let notes: Vec<String> = doubt.into_iter().chain(killed).collect();
    Ok((!notes.is_empty()).then(|| notes.join("\n")))
}
