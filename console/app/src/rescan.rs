//! `tankops rescan`: a mission for what past runs have missed.

use crate::{
    cli::RescanArgs,
    failure::{COMPLETE, bad_input},
    output::{say, say_line, write_file},
    past_runs, planners,
};
use anyhow::Context;
use mission::PlannerInfo;
use planner_host::PluginDirs;
use report::PastRun;
use runs::Past;
use scenario::Scenario;
use std::process::ExitCode;

/// Boxes in a scenario for a re-scan; more are joined into coarser ones.
const MOST_BOXES: usize = 4000;

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
    past.iter().try_for_each(print_doubt)?;
    let (opened, past): (Vec<_>, Vec<PastRun>) = past.into_iter().map(|past| (past.opened, past.run)).unzip();
    let again = report::rescan(&past, min_area_m2, MOST_BOXES).map_err(bad_input)?;
    if again.boxes.is_empty() {
        say(&again.human_out_of_reach())?;
        return Err(bad_input(format!("{}; --min-area-m2 sets the limit", again.why_nothing(min_area_m2))));
    }
    let names: Vec<&str> = past.iter().map(|run| run.name.as_str()).collect();
    let last = opened.last().context("there is no run")?;
    let text = scenario::rescan(last, &names, &again.boxes, &again.found);
    let text = text.context("reading the scenario again")?;
    let scenario = Scenario::parse(&text, &output.display().to_string());
    let scenario = scenario.map_err(|errors| bad_input(errors.render()))?;
    write_file("the scenario", output, &text)?;
    say(&format!("{}: {}", output.display(), again.human(min_area_m2)))?;
    print_advice(args, &names, &planners_instead(&scenario, plugins))?;
    Ok(ExitCode::from(COMPLETE))
}

/// Reports a journal that was changed, and refuses one that scanned outside the floor's cells.
fn print_doubt(Past { opened, run, beyond_floor }: &Past) -> anyhow::Result<()> {
    if let Some(tick) = beyond_floor {
        let cells = opened.floor.len();
        return Err(bad_input(format!(
            "run {}: its journal was changed: an event of tick {tick} names cells beyond the {cells} of the floor",
            run.name
        )));
    }
    let Some(doubt) = &run.logs.error else { return Ok(()) };
    say_line(&format!("note: run {}: {doubt}", run.name))
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
fn print_advice(args: &RescanArgs, names: &[&str], instead: &[String]) -> anyhow::Result<()> {
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
