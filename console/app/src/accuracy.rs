//! `tankops accuracy`: how well the stations will locate the robot, place by place, and where they should stand.

mod drawing;

use crate::{
    cli::AccuracyArgs,
    failure::{COMPLETE, bad_input},
    output::{say, say_line, warn_line},
};
use anyhow::Context;
use mission::TaskConfig;
use positioning::{Accuracy, AccuracyMap, Advice, Forecast, advise};
use scenario::Scenario;
use serde::Serialize;
use std::{fmt::Write, process::ExitCode};
use world::Point;

/// Cells along the longer side of the floor.
const CELLS: f64 = 80.0;
/// The largest error of a whole scan, fixes and odometry filtered, as a share of a single fix's 95 % error; as measured in
/// flights.
const FILTERED: f64 = 0.65;
/// Places beyond the limit that people are shown.
const MOST_SHOWN: usize = 12;

/// A forecast as scripts read it.
#[derive(Debug, Serialize)]
struct ForecastReport<'a> {
    scenario: &'a str,
    limit_m: f64,
    stations: Vec<Placed<'a>>,
    mean_error_95_m: Option<f64>,
    p95_error_95_m: Option<f64>,
    worst_error_95_m: Option<f64>,
    blind_share: f64,
    beyond_limit_share: f64,
    beyond_limit_area_m2: f64,
    /// The worst first.
    beyond_limit: Vec<Place>,
    map: &'a AccuracyMap,
    advice: Option<Advice>,
}

#[derive(Debug, Serialize)]
struct Placed<'a> {
    name: &'a str,
    at: Point,
}

#[derive(Debug, Serialize)]
struct Place {
    at: Point,
    #[serde(flatten)]
    accuracy: Accuracy,
}

/// `tankops accuracy`.
pub(crate) fn accuracy(args: &AccuracyArgs) -> anyhow::Result<ExitCode> {
    let scenario = crate::read_scenario(&args.scenario, &args.changes)?;
    let drawing = scenario.sim.world.as_drawn();
    let forecast = forecast(&scenario);
    let map = AccuracyMap::new(&drawing, &forecast);
    let advice = args.advise.map(|count| advise(&drawing, count, &forecast)).transpose();
    let advice = advice.map_err(|error| bad_input(format!("--advise: {error}")))?;
    let report = forecast_report(&scenario, &map, advice);
    if let Some(file) = &args.svg {
        let places = report.advice.as_ref().map_or(&[][..], |advice| &advice.places);
        let picture = drawing::svg(&drawing, &map, report.limit_m, places);
        std::fs::write(file, picture).map_err(|error| {
            bad_input(format!("the drawing cannot be written: {error}: {}", file.display()))
        })?;
    }
    if args.json {
        say_line(&serde_json::to_string(&report).context("writing the forecast as JSON")?)?;
    } else {
        say(&words(&report))?;
    }
    Ok(ExitCode::from(COMPLETE))
}

/// Warns of a scan with so little clearance that the position error may use it up.
///
/// Costs as much as the map: one forecast for each of some thousand places.
pub(crate) fn warn_of_clearance(scenario: &Scenario) {
    if let Some(warning) = clearance_warning(scenario) {
        warn_line(&format!("warning: {}: {warning}", scenario.shown_name));
    }
}

/// The robot sees how far off columns are, but not walls.
fn clearance_warning(scenario: &Scenario) -> Option<String> {
    let clearance_m = scenario.mission.clearance_m;
    let map = AccuracyMap::new(&scenario.sim.world.as_drawn(), &forecast(scenario));
    let expected_m = FILTERED * forecast_report(scenario, &map, None).p95_error_95_m?;
    let is_scan = matches!(scenario.mission.task, TaskConfig::Cover { .. });
    (is_scan && clearance_m < expected_m).then(|| {
        format!(
            "mission.clearance_m is {clearance_m:.2} m, and the position will be off by up to about {expected_m:.2} m: the \
             hull may touch a wall; more clearance or better stations are right (`tankops accuracy`)"
        )
    })
}

/// What the mission's own estimator may expect of its stations.
fn forecast(scenario: &Scenario) -> Forecast {
    let (low, high) = scenario.sim.world.boundary.bounds();
    scenario.mission.forecast((high - low).amax() / CELLS)
}

fn forecast_report<'a>(
    scenario: &'a Scenario,
    map: &'a AccuracyMap,
    advice: Option<Advice>,
) -> ForecastReport<'a> {
    let limit_m = scenario.mission.position_limit_m;
    let mut errors: Vec<f64> = map.floor().filter_map(|(_, cell)| cell.error_95_m).collect();
    errors.sort_by(f64::total_cmp);
    let n_floor = map.floor().count().max(1) as f64;
    let beyond: Vec<Place> =
        map.beyond(limit_m).into_iter().map(|(at, accuracy)| Place { at, accuracy }).collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    ForecastReport {
        scenario: &scenario.name,
        limit_m,
        stations: scenario
            .sim
            .world
            .stations
            .iter()
            .map(|station| Placed { name: &station.name, at: station.position })
            .collect(),
        mean_error_95_m: (!errors.is_empty()).then_some(mean),
        p95_error_95_m: errors.get(errors.len() * 95 / 100).copied(),
        worst_error_95_m: errors.last().copied(),
        blind_share: 1.0 - errors.len() as f64 / n_floor,
        beyond_limit_share: beyond.len() as f64 / n_floor,
        beyond_limit_area_m2: beyond.len() as f64 * map.cell_m * map.cell_m,
        beyond_limit: beyond,
        map,
        advice,
    }
}

fn words(report: &ForecastReport<'_>) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let metres = |value: Option<f64>| value.map_or("none".into(), |m| format!("{m:.3} m"));
    let percent = |share: f64| share * 100.0;
    let _ = writeln!(text, "95 % error of a single fix, by the scatter of the ranges");
    let _ = writeln!(text, "mean      {}", metres(report.mean_error_95_m));
    let _ = writeln!(text, "p95       {}", metres(report.p95_error_95_m));
    let _ = writeln!(text, "worst     {}", metres(report.worst_error_95_m));
    let _ = writeln!(text, "no fix    {:.1} % of the floor", percent(report.blind_share));
    let _ = writeln!(
        text,
        "beyond    {:.1} % of the floor, {:.1} m2, above the limit of {:.2} m or without a fix",
        percent(report.beyond_limit_share),
        report.beyond_limit_area_m2,
        report.limit_m
    );
    for place in report.beyond_limit.iter().take(MOST_SHOWN) {
        let error = place.accuracy.error_95_m.map_or("no fix".into(), |m| format!("{m:.3} m"));
        let _ = writeln!(
            text,
            "  at {:6.2}, {:6.2} m  {error:9}  {} stations heard",
            place.at.x, place.at.y, place.accuracy.heard
        );
    }
    let rest = report.beyond_limit.len().saturating_sub(MOST_SHOWN);
    if rest > 0 {
        let _ = writeln!(text, "  and {rest} more cells of {:.2} m", report.map.cell_m);
    }
    if let Some(advice) = &report.advice {
        let _ = writeln!(
            text,
            "advice    {} stations on the wall: mean {:.3} m, worst {:.3} m, no fix on {:.1} % of the floor",
            advice.places.len(),
            advice.mean_error_95_m,
            advice.worst_error_95_m,
            percent(advice.blind_share)
        );
        for place in &advice.places {
            let _ = writeln!(text, "  at_m = [{:.3}, {:.3}]", place.x, place.y);
        }
    }
    text
}
