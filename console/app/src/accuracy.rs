//! `tankops accuracy`: how accurately the stations will locate the robot across the floor, and where to place them.

use crate::{
    cli::AccuracyArgs,
    output::{check_free, write_file},
    plan::planned_path,
};
use account::estimate::forecast;
use command::json::say_json;
use flight::{
    failure::{COMPLETE, bad_input},
    scenarios,
};
use planner_host::PluginDirs;
use positioning::{AccuracyMap, advise};
use report::{
    forecast::{CheckReport, ForecastReport, clearance_warning, mirror_warning, risk_warning},
    print::{say, warn_line},
};
use scenario::Scenario;
use std::process::ExitCode;

/// Runs `tankops accuracy`.
pub(crate) fn accuracy(args: &AccuracyArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let scenario = scenarios::read(&args.scenario, &(&args.changes).into())?;
    args.svg.as_ref().map_or(Ok(()), |file| check_free(file, Some(args.force), &[&args.scenario]))?;
    let (mission, drawing) = (&scenario.mission, scenario.sim.world.as_drawn());
    let forecast = forecast(mission, &drawing);
    let risk = mission.locating.risk.unwrap_or_default();
    let map = AccuracyMap::new(&drawing, &forecast).with_checks(&drawing, &forecast, &risk);
    let advice = args.advise.map(|count| advise(&drawing, count, &forecast)).transpose();
    let advice = advice.map_err(|error| bad_input(format!("--advise: {error}")))?;
    let path = args.plan.then(|| planned_path(&scenario, plugins)).transpose()?;
    let checks = CheckReport::new(mission, &drawing, (&map, &forecast), path.as_deref());
    let report = ForecastReport::new(&scenario.name, mission, &drawing, &map, advice).with_checks(checks);
    if let Some(file) = &args.svg {
        write_file("the drawing", file, &report.svg(&drawing))?;
    }
    if args.json {
        say_json("the forecast", &report)?;
    } else {
        say(&report.human())?;
    }
    Ok(ExitCode::from(COMPLETE))
}

/// Warns if the scan clearance is so small that the position error may exceed it, if all stations lie on one line, and if
/// no protection level exists.
pub(crate) fn warn_of_positions(scenario: &Scenario) {
    let (mission, drawing) = (&scenario.mission, scenario.sim.world.as_drawn());
    let warnings = [
        clearance_warning(mission, &drawing),
        mirror_warning(mission, &drawing),
        risk_warning(mission, &drawing),
    ];
    for warning in warnings.into_iter().flatten() {
        warn_line(&format!("warning: {}: {warning}", scenario.shown_name));
    }
}
