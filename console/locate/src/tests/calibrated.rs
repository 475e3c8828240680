//! Files that are located with a session calibration.

use super::{Readable, SCENARIO, located, place};
use crate::{Survey, Tally};
use mission::{Event, EventKind};
use scenario::Scenario;
use std::fmt::Write as _;
use world::StationId;

const FIXES: u32 = 120;
/// The bias of station C from the fix `FROM` on, metres.
const BIAS_M: f64 = 0.6;
const FROM: u32 = 60;
const SCALE: f64 = 0.02;

fn scenario(session: &str, stations: usize) -> Scenario {
    let keys = format!("[ae]\nsession_calibration = \"{session}\"");
    let kept = |line: &&str| {
        let name = |n: usize| ["A", "B", "C", "D", "E", "F"][n];
        !(stations..6).any(|n| line.contains(&format!("name = \"{}\"", name(n))))
    };
    let text: Vec<&str> = SCENARIO.lines().filter(kept).collect();
    let text = text.join("\n").replace("[ae]", &keys);
    Scenario::parse(&text, "bare.toml").map_err(|errors| errors.render()).unwrap()
}

/// Readings one minute apart, of a robot that stands in another place each time; all ranges are too long by `SCALE`, and
/// those of station C by `BIAS_M` as well from the fix `FROM` on.
fn readings(scenario: &Scenario, column: &str) -> Readable {
    with_errors(scenario, column, (SCALE, 0.0, BIAS_M))
}

/// Readings with a share and a length by which all ranges are too long, and the bias of station C, metres.
fn with_errors(scenario: &Scenario, column: &str, (scale, length_m, bias_m): (f64, f64, f64)) -> Readable {
    let mut text = format!("t_s,station,{column},true_x_m,true_y_m\n");
    for k in 0..FIXES {
        let at = place(7 * k) + 4.0 * (place(11 * k).coords / 3.0);
        for (i, station) in scenario.sim.world.stations.iter().enumerate() {
            let noise = 0.03 * ((f64::from(k) * 12.9 + i as f64 * 78.2).sin() * 43_758.5).sin();
            let bias_m = length_m + if i == 2 && k >= FROM { bias_m } else { 0.0 };
            let range_m = (at - station.position).norm() * (1.0 + scale) + noise + bias_m;
            // Arrivals of sound at 1000 m/s.
            let value = if column == "range_m" { range_m } else { range_m / 1000.0 };
            writeln!(text, "{},{},{value:.6},{},{}", 60 * k, station.name, at.x, at.y).unwrap();
        }
    }
    Readable::new("r.csv", text)
}

fn of(session: &str) -> (Survey, Tally, Vec<Event>) {
    let scenario = scenario(session, 6);
    let readings = readings(&scenario, "range_m");
    let task = readings.task(&scenario);
    let survey = task.survey().unwrap();
    let (tally, events) = located(&task, &survey);
    (survey, tally, events)
}

#[test]
fn a_station_that_goes_wrong_under_way_is_found_with_its_time() {
    let (survey, tally, events) = of("constant");
    assert!(survey.session.is_some() && !survey.verdict.is_wrong(), "{:?}", survey.verdict);
    let biased: Vec<_> = events
        .iter()
        .filter_map(|event| match event.kind {
            EventKind::StationBiased { station, bias_m, since_s, .. } => {
                Some((station, bias_m, since_s, event.t_s))
            }
            _ => None,
        })
        .collect();
    let [(station, bias_m, since_s, found_s)] = biased[..] else { panic!("{biased:?}") };
    let begun_s = 60.0 * f64::from(FROM);
    assert_eq!(station, StationId(3));
    assert!((bias_m.value - BIAS_M).abs() < 0.1, "{bias_m:?}");
    assert!(since_s <= begun_s && (begun_s..begun_s + 900.0).contains(&found_s), "{since_s} {found_s}");
    let last = events.iter().rev().find_map(|event| match &event.kind {
        EventKind::SessionCalibrated { scale, .. } => Some(*scale),
        _ => None,
    });
    assert!((last.unwrap().value - SCALE).abs() < 2e-3, "{last:?}");
    let [mean_m, most_m] = tally.fix_error_m.unwrap();
    assert!(mean_m < 0.1 && most_m < 0.5, "{mean_m} {most_m}");
}

#[test]
fn without_the_calibration_the_file_is_judged_as_a_whole() {
    let (survey, tally, events) = of("off");
    assert!(survey.session.is_none() && survey.verdict.is_wrong());
    assert!(!tally.fixes.contains_key("ok"), "{:?}", tally.fixes);
    let is_calibrated = |event: &Event| matches!(event.kind, EventKind::SessionCalibrated { .. });
    assert!(!events.iter().any(is_calibrated));
}

#[test]
fn differences_from_too_few_stations_are_not_calibrated() {
    for (stations, is_calibrated) in [(4, false), (5, true)] {
        let scenario = scenario("constant", stations);
        let readings = readings(&scenario, "arrival_s");
        let mut task = readings.task(&scenario);
        task.sound_speed_m_s = Some(1000.0);
        let survey = task.survey().unwrap();
        assert_eq!(survey.session.is_some(), is_calibrated);
        let (_, events) = located(&task, &survey);
        let found = events.iter().any(|event| matches!(event.kind, EventKind::SessionCalibrated { .. }));
        assert_eq!(found, is_calibrated);
    }
}

/// The calibration estimates no common length, and would name sound stations instead.
#[test]
fn a_length_common_to_all_ranges_is_reported_instead_of_wrong_stations() {
    let scenario = scenario("constant", 6);
    let readings = with_errors(&scenario, "range_m", (0.0, 0.2, 0.0));
    let task = readings.task(&scenario);
    let survey = task.survey().unwrap();
    assert!(survey.session.is_none() && survey.verdict.is_length_alone(), "{:?}", survey.verdict);
    let (_, events) = located(&task, &survey);
    assert!(!events.iter().any(|event| matches!(event.kind, EventKind::StationBiased { .. })));
}
