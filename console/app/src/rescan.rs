//! `tankops rescan`: a mission for what past runs have missed.

use crate::{
    cli::RescanArgs,
    output::{check_free, write_file},
};
use flight::{
    failure::{COMPLETE, ENDED_OTHERWISE, bad_input},
    planners,
};
use mission::PlannerInfo;
use planner_host::PluginDirs;
use report::print::{say, say_line};
use review::{MissedScan, NextScan, doubt, missed_scan};
use scenario::Scenario;
use std::process::ExitCode;

/// `tankops rescan RUN... -o SCENARIO`.
pub(crate) fn rescan(args: &RescanArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let (output, min_area_m2) = (&args.output, args.min_area_m2);
    check_free(output, Some(args.force))?;
    if !(min_area_m2.is_finite() && min_area_m2 >= 0.0) {
        return Err(bad_input(format!("--min-area-m2 {min_area_m2}: must be an area of 0 m² or more")));
    }
    let past = review::read_all(&args.runs, &args.logs.folder())?;
    for note in past.iter().map(doubt).collect::<anyhow::Result<Vec<_>>>()?.into_iter().flatten() {
        say_line(&note)?;
    }
    let names: Vec<String> = past.iter().map(|past| past.run.name.clone()).collect();
    let scan = match missed_scan(past, min_area_m2, &output.display().to_string())? {
        NextScan::Worth(scan) => *scan,
        NextScan::Nothing(why) => {
            say_line(&format!("{} is not written: {why}", output.display()))?;
            return Ok(ExitCode::from(ENDED_OTHERWISE));
        }
    };
    let MissedScan { missed, text, scenario } = scan;
    write_file("the scenario", output, &text)?;
    say(&format!("{}: {}", output.display(), missed.human(min_area_m2)))?;
    print_advice(args, &names, &planners_instead(&scenario, plugins))?;
    Ok(ExitCode::from(COMPLETE))
}

/// The planners that can fly the re-scan, if the one that flew the scan cannot.
fn planners_instead(scenario: &Scenario, plugins: &PluginDirs) -> Vec<String> {
    let found = planners::found(plugins).planners;
    let cannot = |info: &PlannerInfo| info.id == scenario.mission.planner.id && !info.covers;
    if !found.iter().any(cannot) {
        return Vec::new();
    }
    found.into_iter().filter(|info| info.covers).map(|info| info.id).collect()
}

/// How the re-scan is flown.
fn print_advice(args: &RescanArgs, names: &[String], instead: &[String]) -> anyhow::Result<()> {
    let (logs, output) = (args.logs.folder(), args.output.display());
    let logs = logs.display();
    let option = if instead.is_empty() { "" } else { " --planner PLANNER" };
    if !instead.is_empty() {
        say_line(&format!(
            "the planner of the run does not support coverage missions; PLANNER is one of {}",
            instead.join(", ")
        ))?;
    }
    Ok(say_line(&format!(
        "run it with `tankops run --logs {logs} {output}{option}`; then `tankops report --logs {logs} {} RUN` shows them \
         together",
        names.join(" "),
    ))?)
}
