//! `tankops rescan`: creates a mission for the areas that past runs missed.

use crate::{
    cli::RescanArgs,
    output::{check_free, write_file},
};
use campaign::shell;
use flight::{
    failure::{COMPLETE, ENDED_OTHERWISE, bad_input},
    planners,
};
use planner_host::PluginDirs;
use report::print::{say, say_line};
use review::{MissedScan, NextScan, doubt, missed_scan};
use scenario::{Scenario, Settings};
use std::{path::Path, process::ExitCode};
use world::Point;

/// Runs `tankops rescan RUN... -o SCENARIO`.
pub(crate) fn rescan(args: &RescanArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let (output, min_area_m2) = (&args.output, args.min_area_m2);
    check_free(output, Some(args.force), &[])?;
    if !(min_area_m2.is_finite() && min_area_m2 >= 0.0) {
        return Err(bad_input(format!("--min-area-m2 {min_area_m2}: must be 0 m² or more")));
    }
    let past = review::read_all(&args.runs, &args.logs.folder())?;
    for note in past.iter().map(doubt).collect::<anyhow::Result<Vec<_>>>()?.into_iter().flatten() {
        say_line(&note)?;
    }
    let vehicle = past.iter().rev().find_map(|past| past.opened.vehicle.as_ref().map(|info| info.at.clone()));
    let names: Vec<String> = past.iter().map(|past| past.run.name.clone()).collect();
    let scan = match missed_scan(past, min_area_m2, &output.display().to_string())? {
        NextScan::Worth(scan) => *scan,
        NextScan::Nothing(why) => {
            say_line(&format!("{} not written: {why}", output.display()))?;
            return Ok(ExitCode::from(ENDED_OTHERWISE));
        }
    };
    let MissedScan { missed, text, scenario, left_out } = scan;
    let (text, changed) = flyable(text, &scenario, output, plugins)?;
    write_file("the scenario", output, &text)?;
    say(&format!("{}: {}", output.display(), missed.human(min_area_m2)))?;
    if !left_out.is_empty() {
        say_line(&format!(
            "left out, because these faults happened in the old run: {}",
            left_out.join(", ")
        ))?;
    }
    if let Some(note) = changed {
        say_line(&note)?;
    }
    print_advice(args, &names, vehicle.map(|at| (at, scenario.mission.start.position)))?;
    Ok(ExitCode::from(COMPLETE))
}

/// The scenario text, changed if necessary to name a planner that can run it, and a note on the change.
fn flyable(
    text: String,
    scenario: &Scenario,
    output: &Path,
    plugins: &PluginDirs,
) -> anyhow::Result<(String, Option<String>)> {
    let found = planners::found(plugins);
    let mission = &scenario.mission;
    let why = |id: &str| {
        let info = found.planners.iter().find(|info| info.id == id)?;
        planners::why_unsuited(info, &mission.task)
    };
    let Some((why, suited)) = why(&mission.planner.id).zip(planners::suited_to_coverage(&found)) else {
        return Ok((text, None));
    };
    let settings = Settings { planner: Some(suited.id.clone()), ..Settings::default() };
    let shown = output.display().to_string();
    let text = settings.put_into(&text).map_err(|what| bad_input(format!("{shown}: {what}")))?;
    Scenario::parse(&text, &shown).map_err(|errors| bad_input(errors.render()))?;
    let note =
        format!("planner {} replaces {}, the planner of the run, which {why}", suited.id, mission.planner.id);
    Ok((text, Some(note)))
}

/// Prints how to run the re-scan; `live` is the address of the vehicle of the last live run, and the start.
fn print_advice(args: &RescanArgs, names: &[String], live: Option<(String, Point)>) -> anyhow::Result<()> {
    let quoted = |path: &Path| shell(&path.display().to_string());
    let (logs, output) = (quoted(&args.logs.folder()), quoted(&args.output));
    let (place, vehicle) = match live {
        Some((at, start)) => (
            format!("place the vehicle at the start, {:.2}, {:.2} m; then ", start.x, start.y),
            format!(" --vehicle {}", shell(&at)),
        ),
        None => (String::new(), String::new()),
    };
    Ok(say_line(&format!(
        "{place}run it with `tankops run --logs {logs} {output}{vehicle}`; then combine the reports with `tankops report --logs \
         {logs} {} RUN`",
        names.iter().map(|name| shell(name)).collect::<Vec<_>>().join(" "),
    ))?)
}
