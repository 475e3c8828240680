//! The figures of very short runs that can be worked out by hand, and of one run with every kind of event.

#![allow(clippy::unwrap_used, clippy::float_cmp, reason = "tests with exact figures")]

use super::*;
use crate::samples::{chosen, estimated, event, fold, full_run, opened, truth, zone_drawn};
use crate::{DoubtWatch, InDoubt};
use mission::{During, Fault};
use serde_json::{Value, json};
use world::CellRun;

#[test]
fn nothing_is_known_of_no_events() {
    let nothing = Summary { report_version: Some(REPORT_VERSION), ..Summary::default() };
    assert_eq!(Fold::new().summary(), nothing);
}

#[test]
fn the_path_is_as_long_as_the_true_way() {
    let run = fold(&[
        (0, truth(0.0, 0.0, 0.5, false)),
        (1, truth(3.0, 4.0, 0.2, true)),
        (2, truth(3.0, 5.0, 0.3, false)),
    ])
    .summary();
    assert_eq!(run.path_length_m, Some(6.0));
    assert_eq!((run.clearance_min_m, run.collisions), (Some(0.2), Some(1)));
    assert_eq!((run.ticks, run.mission_time_s, run.outcome), (Some(2), Some(1.0), None));
}

#[test]
fn position_errors_are_paired_by_tick() {
    let run = fold(&[
        (0, truth(0.0, 0.0, 1.0, false)),
        (0, estimated(0.1, 0.0, 0.1)),
        (1, estimated(1.3, 0.0, 0.1)),
        (1, truth(1.0, 0.0, 1.0, false)),
        (2, truth(2.0, 0.0, 1.0, false)),
        (3, estimated(9.0, 0.0, 0.1)),
    ]);
    let positioning = run.summary().positioning.unwrap();
    assert!((positioning.mean_error_m - 0.2).abs() < 1e-12);
    assert!((positioning.p50_m - 0.1).abs() < 1e-12);
    assert!((positioning.p95_m - 0.3).abs() < 1e-12 && (positioning.max_m - 0.3).abs() < 1e-12);
    // An error of 0.1 m lies within 2.45 sigma of 0.1 m; an error of 0.3 m does not.
    assert!((positioning.in_95_ellipse - 0.5).abs() < 1e-12);
}

#[test]
fn lost_time_counts_until_regained_or_the_end() {
    let lost = json!({ "event": "position_lost", "error_m": 0.6, "limit_m": 0.5 });
    let regained = json!({ "event": "position_regained", "error_m": 0.4 });
    let run = fold(&[
        (0, truth(0.0, 0.0, 1.0, false)),
        (0, estimated(0.0, 0.0, 0.1)),
        (2, lost.clone()),
        (6, regained),
        (10, lost),
        (14, truth(0.0, 0.0, 1.0, false)),
    ]);
    assert_eq!(run.summary().positioning.unwrap().position_lost_s, 2.0 + 2.0);
}

#[test]
fn coverage_counts_believed_and_true_cells() {
    // The grid has 8 by 8 cells, all reachable; two rows of eight cells count as scanned by the estimate.
    let run = fold(&[
        (0, opened()),
        (1, json!({ "event": "covered", "runs": [[24, 8]] })),
        (2, json!({ "event": "covered", "runs": [[32, 8]] })),
        (3, truth(-1.75, 0.0, 1.0, false)),
        (4, truth(1.75, 0.0, 1.0, false)),
    ]);
    let coverage = run.summary().coverage.unwrap();
    assert_eq!((coverage.reachable, coverage.whole), (0.25, 0.25));
    assert_eq!(coverage.missed_area_m2, None, "the task was not to scan");
    assert_eq!(coverage.by_truth.unwrap().whole, 0.25);
    assert_eq!(coverage.overlap, Some(0.0));
    assert_eq!(coverage.by_truth.unwrap().scanned_truly, Some(1.0));
}

#[test]
fn going_back_over_everything_is_an_overlap_of_nearly_one() {
    let there = (0..=35).map(|k| -1.75 + f64::from(k) * 0.1);
    let back = (0..=35).map(|k| 1.75 - f64::from(k) * 0.1);
    let start = json!({ "event": "ordered", "order": "start" });
    let mut events = vec![(0, opened()), (0, start), (0, json!({ "event": "covered", "runs": [[24, 16]] }))];
    events.extend(there.chain(back).enumerate().map(|(i, x)| (i as u64, estimated(x, 0.0, 0.01))));
    let overlap = fold(&events).summary().coverage.unwrap().overlap.unwrap();
    // Near its turning point, the robot came back after less than two swaths of path, so those cells do not count as
    // scanned again.
    assert!((0.5..0.9).contains(&overlap), "{overlap}");
}

#[test]
fn floor_that_is_passed_while_a_held_robot_brakes_has_an_error_and_is_guaranteed() {
    let start = json!({ "event": "ordered", "order": "start" });
    let held = json!({ "event": "held", "by": "operator" });
    // The robot is held at 0.25 m, and stops 1 m farther on.
    let run = fold(&[
        (0, opened()),
        (0, start),
        (1, estimated(0.25, 0.0, 0.01)),
        (1, held),
        (2, estimated(0.75, 0.0, 0.01)),
        (3, estimated(1.25, 0.0, 0.01)),
        (3, json!({ "event": "covered", "runs": [[24, 7], [32, 7]] })),
    ]);
    let scanned = run.scanned().unwrap();
    let covered: Vec<usize> =
        (0..scanned.believed().floor().len()).filter(|cell| scanned.believed().is_covered(*cell)).collect();
    assert_eq!(covered.len(), 14);
    for cell in covered {
        let passes = scanned.passes();
        assert!(passes.error_mm(cell).is_some() && passes.is_guaranteed(cell), "cell {cell}");
    }
}

#[test]
fn a_biased_station_takes_the_guarantee_back_until_a_later_pass() {
    let start = json!({ "event": "ordered", "order": "start" });
    let bias_m = json!({ "value": 0.15, "sigma": 0.02 });
    let biased = json!({
        "event": "station_biased", "station": 1, "bias_m": bias_m, "since_s": 1.0, "is_corrected": false
    });
    let there = [(0, opened()), (0, start), (1, estimated(0.25, 0.0, 0.01)), (3, estimated(1.25, 0.0, 0.01))];
    let passed = |events: &[(u64, Value)]| {
        let run = fold(events);
        let (scanned, taken) = (run.scanned().unwrap(), run.summary().taken_back);
        let taken = taken.first().cloned();
        let count =
            |is: &dyn Fn(usize) -> bool| (0..scanned.believed().floor().len()).filter(|c| is(*c)).count();
        let passes = scanned.passes();
        (count(&|cell| passes.is_guaranteed(cell)), count(&|cell| passes.is_in_doubt(cell)), taken)
    };
    let (early, ..) = passed(&there[..3]);
    let (all, none, _) = passed(&there);
    assert!(early > 0 && all > early && none == 0, "{early} of {all}");
    let doubted = [&there[..], &[(4, biased)]].concat();
    let (left, in_doubt, taken) = passed(&doubted);
    assert_eq!((left, in_doubt), (early, all - early));
    let taken = taken.unwrap();
    assert!(taken.area_m2 > 0.0 && taken.left_m2 == Some(taken.area_m2), "{taken:?}");
    assert!(taken.to_string().ends_with("wrong by +0.15 ± 0.04 m"), "{taken}");
    let back = [&doubted[..], &[(5, estimated(0.25, 0.0, 0.01))]].concat();
    let (again, in_doubt, taken) = passed(&back);
    assert_eq!((again, in_doubt), (all, 0));
    // The report explains why the re-scan lists less than was taken back.
    let taken = taken.unwrap();
    assert_eq!(taken.left_m2, Some(0.0));
    let words =
        format!("later passes of this run guarantee {:.1} m² of it, 0.0 m² stay in doubt", taken.area_m2);
    assert!(taken.to_string().ends_with(&words), "{taken}");
}

#[test]
fn the_floor_in_doubt_is_listed_as_in_the_report_with_its_place() {
    let start = json!({ "event": "ordered", "order": "start" });
    let biased = json!({
        "event": "station_biased", "station": 1, "bias_m": { "value": 0.15, "sigma": 0.02 }, "since_s": 1.0,
        "is_corrected": false
    });
    let mut opened = event(0, &opened());
    assert!(DoubtWatch::opening(&opened).is_none(), "this mission looks for no biased stations");
    if let EventKind::RunOpened(run) = &mut opened.kind {
        run.mission.locating.session = Some(positioning::SessionConfig::default());
    }
    let mut watch = DoubtWatch::opening(&opened).unwrap();
    let mut reported = Fold::new();
    reported.apply(&opened);
    let there = [(0, start), (1, estimated(0.25, 0.0, 0.01)), (3, estimated(1.25, 0.0, 0.01))];
    for (tick, kind) in &there {
        assert!(watch.apply(&event(*tick, kind)).is_none());
        reported.apply(&event(*tick, kind));
    }
    let biased = event(4, &biased);
    let listed = watch.apply(&biased).unwrap().to_vec();
    reported.apply(&biased);
    let floors: Vec<TakenBack> = listed.iter().map(|doubt| doubt.floor.clone()).collect();
    assert!(!floors.is_empty() && floors == reported.taken_back(), "{floors:?}");
    let summary = reported.summary().taken_back;
    assert_eq!((summary[0].area_m2, summary[0].left_m2), (floors[0].area_m2, Some(floors[0].area_m2)));
    // Only the second half of the way is in doubt.
    let at = listed[0].at.unwrap();
    assert!(at.x > 0.5 && at.x < 1.6 && at.y.abs() < 0.3, "{at}");
    let cells = |doubt: &InDoubt| doubt.cells.iter().map(|CellRun(_, count)| *count).sum::<u32>();
    let scanned = reported.scanned().unwrap();
    let area_m2 = |doubt: &InDoubt| f64::from(cells(doubt)) * scanned.believed().floor().cell_m2();
    assert!((area_m2(&listed[0]) - floors[0].area_m2).abs() < 1e-9, "{listed:?}");
    // What a later pass guarantees is taken off the list when the run has ended.
    let ended = event(6, &json!({ "event": "ended", "outcome": "complete", "reason": "done" }));
    let left = watch.apply(&ended).unwrap().to_vec();
    assert_eq!((cells(&left[0]), left[0].floor.left_m2), (cells(&listed[0]), Some(floors[0].area_m2)));
    let mut watch = DoubtWatch::opening(&opened).unwrap();
    let back = event(5, &estimated(0.25, 0.0, 0.01));
    let there = there.iter().map(|(tick, kind)| event(*tick, kind));
    let lists: Vec<usize> = there
        .chain([biased, back, ended])
        .filter_map(|event| watch.apply(&event).map(|list| list[0].cells.len()))
        .collect();
    assert!(lists.len() == 2 && lists[0] > 0 && lists[1] == 0, "{lists:?}");
}

#[test]
fn nothing_counts_before_the_start() {
    let run = fold(&[(0, opened()), (0, estimated(-1.75, 0.0, 0.01)), (1, estimated(-1.25, 0.0, 0.01))]);
    let passes = run.scanned().unwrap().passes();
    assert!((0..64).all(|cell| passes.error_mm(cell).is_none()));
}

#[test]
fn parameters_are_those_of_the_first_planner_with_defaults_and_changes() {
    let changed =
        json!({ "event": "parameters_changed", "choice": { "id": "rpf", "parameters": { "k_rep": 3.0 } } });
    let run = fold(&[(0, opened()), (0, chosen("rpf")), (5, changed), (9, chosen("apf"))]).summary();
    assert_eq!(run.planner.as_deref(), Some("rpf"));
    assert_eq!(run.planners, ["rpf", "apf"]);
    let expected =
        [("k_att", 1.0), ("k_rep", 3.0)].map(|(key, value)| (key.to_owned(), ParamValue::Float(value)));
    assert_eq!(run.parameters, Some(Parameters::from(expected)));
}

#[test]
fn a_planner_that_the_console_refused_has_not_failed() {
    let failed = |cause: &Cause| {
        let (planner, message) = ("apf".to_owned(), "words".to_owned());
        let (cause, during) = (*cause, During::Load);
        let fault = Fault { planner, during, cause, message, partial: Vec::new(), plugin_sha256: None };
        (1, json!({ "event": "planner_failed", "fault": fault }))
    };
    let faults =
        |causes: &[Cause]| fold(&causes.iter().map(failed).collect::<Vec<_>>()).summary().planner_faults;
    assert_eq!(faults(&[Cause::Refused, Cause::Quarantined]), 0);
    assert_eq!(faults(&[Cause::Panic, Cause::Refused, Cause::Starved]), 2);
}

#[test]
fn the_json_object_has_every_figure() {
    insta::assert_json_snapshot!(rounded(serde_json::to_value(full_run()).unwrap()));
}

#[test]
fn an_empty_run_has_every_key_and_null_for_what_is_absent() {
    insta::assert_json_snapshot!(Summary::default());
}

#[test]
fn a_summary_survives_its_own_json() {
    let run = full_run();
    let text = serde_json::to_string(&run).unwrap();
    assert_eq!(serde_json::from_str::<Summary>(&text).unwrap(), run);
}

/// Numbers to nine digits, so that the snapshot does not depend on the last bit.
fn rounded(value: Value) -> Value {
    match value {
        Value::Number(n) if n.is_f64() => json!((n.as_f64().unwrap() * 1e9).round() / 1e9),
        Value::Array(list) => list.into_iter().map(rounded).collect(),
        Value::Object(map) => {
            Value::Object(map.into_iter().map(|(key, value)| (key, rounded(value))).collect())
        }
        other => other,
    }
}

#[test]
fn a_zone_drawn_under_way_is_reported_for_every_task_with_who_drew_it_and_when() {
    let start = json!({ "event": "ordered", "order": "start" });
    let run = fold(&[(0, opened()), (0, start), (4, zone_drawn(0.0, 0.5))]).summary();
    let zone = serde_json::to_value(&run).unwrap()["zones_drawn"][0].clone();
    assert_eq!(
        (&zone["name"], &zone["by"], &zone["t_s"]),
        (&json!("no-go 1"), &json!("operator"), &json!(2.0))
    );
}
