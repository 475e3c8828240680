//! `tankops rescan`: a mission for what past runs have missed.

use crate::{
    cli::{LogsArg, RescanArgs},
    failure::{COMPLETE, bad_input},
    output::{say, say_line, write_file},
    past_runs, planners,
};
use anyhow::Context;
use mission::PlannerInfo;
use planner_host::PluginDirs;
use report::{PastRun, Rescan};
use runs::Past;
use scenario::Scenario;
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

/// Boxes in a scenario for a re-scan; more are joined into coarser ones.
const MOST_BOXES: usize = 4000;
/// Smaller missed areas are not worth a mission, square metres.
pub(crate) const MIN_AREA_M2: f64 = 0.05;

/// `tankops rescan RUN... -o SCENARIO`.
pub(crate) fn rescan(args: &RescanArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let (output, min_area_m2) = (&args.output, args.min_area_m2);
    if output.exists() {
        return Err(bad_input(format!("{} already exists; choose another name", output.display())));
    }
    if !(min_area_m2.is_finite() && min_area_m2 >= 0.0) {
        return Err(bad_input(format!("--min-area-m2 {min_area_m2}: must be an area of 0 m² or more")));
    }
    let past = past_runs::read_all(&args.runs, &args.logs)?;
    for note in past.iter().map(doubt).collect::<anyhow::Result<Vec<_>>>()?.into_iter().flatten() {
        say_line(&note)?;
    }
    let names: Vec<String> = past.iter().map(|past| past.run.name.clone()).collect();
    let Again { missed, text, scenario } = again(past, min_area_m2, &output.display().to_string())?;
    write_file("the scenario", output, &text)?;
    say(&format!("{}: {}", output.display(), missed.human(min_area_m2)))?;
    print_advice(args, &names, &planners_instead(&scenario, plugins))?;
    Ok(ExitCode::from(COMPLETE))
}

/// What past runs missed, and the scenario that scans it.
struct Again {
    missed: Rescan,
    text: String,
    scenario: Scenario,
}

/// The scenario that scans what past runs missed.
///
/// # Errors
/// The runs do not go together, or nothing that can be reached was missed.
fn again(past: Vec<Past>, min_area_m2: f64, shown_name: &str) -> anyhow::Result<Again> {
    let (opened, past): (Vec<_>, Vec<PastRun>) = past.into_iter().map(|past| (past.opened, past.run)).unzip();
    let missed = report::rescan(&past, min_area_m2, MOST_BOXES).map_err(bad_input)?;
    if missed.boxes.is_empty() {
        let why = missed.why_nothing(min_area_m2);
        return Err(bad_input(format!("{}{why}; --min-area-m2 sets the limit", missed.human_out_of_reach())));
    }
    let names: Vec<&str> = past.iter().map(|run| run.name.as_str()).collect();
    let last = opened.last().context("there is no run")?;
    let text = scenario::rescan(last, &names, &missed.boxes, &missed.found);
    let text = text.context("reading the scenario again")?;
    let scenario = Scenario::parse(&text, shown_name).map_err(|errors| bad_input(errors.render()))?;
    Ok(Again { missed, text, scenario })
}

/// The scenario that scans what past runs missed, for the console.
///
/// # Errors
/// See [`again`]; also a journal that was changed.
pub(crate) fn scenario_for(runs: &[String], logs: &Path) -> anyhow::Result<Scenario> {
    let runs: Vec<PathBuf> = runs.iter().map(PathBuf::from).collect();
    let past = past_runs::read_all(&runs, &LogsArg { logs: logs.to_owned() })?;
    past.iter().map(doubt).collect::<anyhow::Result<Vec<_>>>()?;
    let shown_name = format!("the re-scan of {}", past.last().map_or("", |past| past.run.name.as_str()));
    Ok(again(past, MIN_AREA_M2, &shown_name)?.scenario)
}

/// What speaks against a journal, as a note.
///
/// # Errors
/// It scanned outside the floor's cells.
fn doubt(Past { opened, run, beyond_floor }: &Past) -> anyhow::Result<Option<String>> {
    if let Some(tick) = beyond_floor {
        let cells = opened.floor.len();
        return Err(bad_input(format!(
            "run {}: its journal was changed: an event of tick {tick} names cells beyond the {cells} of the floor",
            run.name
        )));
    }
    Ok(run.logs.error.as_ref().map(|doubt| format!("note: run {}: {doubt}", run.name)))
}

/// The planners that can fly the re-scan, if the one that flew the scan cannot.
fn planners_instead(scenario: &Scenario, plugins: &PluginDirs) -> Vec<String> {
    let found = planners::found(plugins);
    let cannot = |info: &PlannerInfo| info.id == scenario.mission.planner.id && !info.covers;
    if !found.iter().any(cannot) {
        return Vec::new();
    }
    found.into_iter().filter(|info| info.covers).map(|info| info.id).collect()
}

/// How the re-scan is flown.
fn print_advice(args: &RescanArgs, names: &[String], instead: &[String]) -> anyhow::Result<()> {
    let (logs, output) = (args.logs.logs.display(), args.output.display());
    let option = if instead.is_empty() { "" } else { " --planner PLANNER" };
    if !instead.is_empty() {
        say_line(&format!(
            "the planner of the run does not support coverage missions; PLANNER is one of {}",
            instead.join(", ")
        ))?;
    }
    say_line(&format!(
        "run it with `tankops run --logs {logs} {output}{option}`; then `tankops report --logs {logs} {} RUN` shows them \
         together",
        names.join(" "),
    ))
}
