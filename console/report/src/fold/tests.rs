//! The figures of tiny runs whose figures can be worked out by hand, and of one with everything in it.

#![allow(clippy::unwrap_used, clippy::float_cmp, reason = "tests with exact figures")]

use super::*;
use crate::{
    human::human,
    summary::{Logs, PlannerCalls, Stops},
};
use mission::{During, Fault};
use serde_json::{Value, json};
use world::Point;

fn event(tick: u64, kind: &Value) -> Event {
    let mut event = json!({ "tick": tick, "t_s": tick as f64 * 0.5 });
    event.as_object_mut().unwrap().extend(kind.as_object().unwrap().clone());
    serde_json::from_value(event).unwrap()
}

fn fold(events: &[(u64, Value)]) -> Fold {
    let mut fold = Fold::new();
    for (tick, kind) in events {
        fold.apply(&event(*tick, kind));
    }
    fold
}

fn truth(x: f64, y: f64, clearance_m: f64, collided: bool) -> Value {
    let pose = json!({ "position": [x, y], "heading_rad": 0.0 });
    json!({ "event": "truth", "pose": pose, "clearance_m": clearance_m, "collided": collided })
}

/// An estimate whose 95 % ellipse is a circle of `sigma_m` times 2.4477.
fn estimated(x: f64, y: f64, sigma_m: f64) -> Value {
    let v = sigma_m * sigma_m;
    let covariance = json!([v, 0.0, 0.0, 0.0, v, 0.0, 0.0, 0.0, 0.01]);
    json!({ "event": "estimated", "pose": { "position": [x, y], "heading_rad": 0.0, "covariance": covariance } })
}

/// A square tank of 4 m with the robot at its west end, bound for its east end; cells of 0.5 m, a swath of 1 m.
fn opened() -> Value {
    let corners = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)].map(|(x, y)| Point::new(x, y));
    let world = world::World {
        boundary: world::Boundary::Polygon { vertices: corners.to_vec() },
        obstacles: Vec::new(),
        stations: Vec::new(),
        zones: Vec::new(),
    };
    let floor = world::Floor::new(&world, 0.5, 0.0, 1.0, Point::new(-1.75, 0.25));
    let limits = json!({ "motion": "point", "v_max_m_per_s": 1.0, "w_max_rad_per_s": 1.0, "radius_m": 0.0, "sensing_range_m": 2.0 });
    let mission = json!({
        "task": { "follow": { "path": [[-1.75, 0.0], [1.75, 0.0]], "tolerance_m": 0.2 } },
        "start": { "position": [-1.75, 0.0], "heading_rad": 0.0 },
        "start_sigma_m": 0.0, "tick_s": 0.5, "time_limit_s": 100.0, "limits": limits, "swath_m": 1.0,
        "clearance_m": 0.0, "cell_m": 0.5, "position_limit_m": 0.5, "position_lost_hold_s": 2.0, "stuck_s": 30.0,
        "start_heading_sigma_rad": 0.02, "odometry_turn_sigma_per_rad": 0.02, "gyro_sigma_rad_per_s": 0.001,
        "odometry_sigma_per_m": 0.02, "range_sigma_ratio": 0.03,
        "planner": { "id": "rpf", "parameters": { "k_rep": 2.0 } }, "fallback": null,
    });
    json!({
        "event": "run_opened", "journal_version": 1, "tankops_version": "0.1.0", "scenario": "tiny",
        "scenario_toml": "", "seed": 7, "world": world, "mission": mission, "floor": floor,
    })
}

/// A round tank of 5 m with a column, a robot that keeps 0.45 m from anything and a bar of 0.6 m.
pub(crate) fn round_tank(cell_m: f64) -> RunOpened {
    let mut run: Value = opened();
    let column = Obstacle {
        id: world::ObstacleId(1),
        name: "column".into(),
        shape: world::Shape::Disc { center: Point::new(0.0, 3.0), radius_m: 0.2 },
        known: true,
    };
    let world = world::World {
        boundary: world::Boundary::Circle { radius_m: 5.0 },
        obstacles: vec![column],
        stations: Vec::new(),
        zones: Vec::new(),
    };
    let plates = world::RegularPlates { annular_m: 0.6, n_annular: 6, length_m: 3.0, width_m: 1.5 };
    let mission = &mut run["mission"];
    mission["task"] = json!({ "cover": { "anchor": [-1.75, 0.0], "regions": [], "tolerance_m": 0.2 } });
    mission["limits"]["motion"] = json!("unicycle");
    (mission["limits"]["radius_m"], mission["clearance_m"]) = (json!(0.25), json!(0.2));
    (mission["swath_m"], mission["cell_m"]) = (json!(0.6), json!(cell_m));
    run["floor"] = json!(world::Floor::new(&world, cell_m, 0.45, 0.6, Point::origin()));
    (run["world"], run["plates"]) = (json!(world), json!(plates));
    let EventKind::RunOpened(run) = event(0, &run).kind else { panic!("that is what it is") };
    *run
}

fn chosen(id: &str) -> Value {
    let parameter = |key: &str, default: f64| {
        json!({ "key": key, "label": key, "unit": "", "help": "", "group": "", "kind": "float",
                "min": 0.0, "max": 9.0, "default": default, "live": true })
    };
    let info = json!({
        "id": id, "name": id, "version": "0.1.0", "about": "", "plugin": "x.so", "sha256": "", "abi": "1.0",
        "parameters": [parameter("k_att", 1.0), parameter("k_rep", 1.0)],
    });
    json!({ "event": "planner_chosen", "choice": { "id": id, "parameters": { "k_rep": 2.0 } }, "info": info, "from": null })
}

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
    // 0.1 m lies within 2.45 sigma of 0.1 m, 0.3 m does not.
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
    // The grid has 8 by 8 cells, all reachable; two rows of eight are believed scanned.
    let run = fold(&[
        (0, opened()),
        (1, json!({ "event": "covered", "runs": [[24, 8]] })),
        (2, json!({ "event": "covered", "runs": [[32, 8]] })),
        (3, truth(-1.75, 0.0, 1.0, false)),
        (4, truth(1.75, 0.0, 1.0, false)),
    ]);
    let coverage = run.summary().coverage.unwrap();
    assert_eq!((coverage.reachable, coverage.whole), (0.25, 0.25));
    assert_eq!(coverage.missed_area_m2, None, "the mission was not to scan");
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
    // Where it turned it had not gone two swaths since: those cells do not count again.
    assert!((0.5..0.9).contains(&overlap), "{overlap}");
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

/// A run with something of everything.
fn full_run() -> Summary {
    let mut events = vec![(0, opened()), (0, chosen("rpf"))];
    for k in 0..=35_u64 {
        let x = -1.75 + k as f64 * 0.1;
        events.push((k, truth(x, 0.05, 0.5 - k as f64 * 0.01, k == 20)));
        events.push((k, estimated(x + 0.03, 0.05, 0.02)));
        events.push((k, json!({ "event": "covered", "runs": [[24 + k.min(7), 1], [32 + k.min(7), 1]] })));
        events.push((k, json!({
            "event": "progressed", "done": k as f64 / 35.0, "along_m": k as f64 * 0.1, "cross_track_m": 0.05,
            "target": [1.75, 0.0], "covered_reachable": 0.2, "covered_whole": 0.2,
        })));
    }
    events.push((21, json!({ "event": "held", "by": "operator" })));
    events.push((
        36,
        json!({ "event": "ended", "outcome": "complete", "reason": "the last preset point is reached" }),
    ));
    Summary {
        wall_time_s: Some(0.042),
        planner_calls: Some(PlannerCalls {
            plan: 1,
            step: 36,
            p50_us: Some(21.4),
            p99_us: Some(88.0),
            faults: 0,
        }),
        stops: Stops::of(&[0.8, 1.2, 2.4]),
        events_sha256: Some("5e1f".into()),
        logs: Some(Logs {
            journal: Some("logs/run/events.jsonl".into()),
            recording: None,
            error: None,
            is_open: false,
        }),
        ..fold(&events).summary()
    }
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
fn the_text_for_people() {
    insta::assert_snapshot!(human(&full_run()));
}

#[test]
fn the_text_of_a_run_that_was_cut_off() {
    let run = fold(&[(0, opened()), (0, chosen("rpf")), (0, truth(-1.75, 0.0, 0.2, false))]).summary();
    insta::assert_snapshot!(human(&run));
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

/// A zone that was drawn under way: a box of 1 m by 2 m.
fn zone_drawn(x: f64, y: f64) -> Value {
    let vertices = [(x, y), (x + 1.0, y), (x + 1.0, y + 2.0), (x, y + 2.0)].map(|(x, y)| Point::new(x, y));
    let shape = world::Shape::Polygon { vertices: vertices.to_vec() };
    let zone = Zone { name: "no-go 1".into(), kind: world::ZoneKind::NoGo, shape };
    json!({ "event": "zone_drawn", "zone": zone })
}

#[test]
fn a_zone_drawn_under_way_is_reported_for_every_task_with_who_drew_it_when_and_where() {
    let start = json!({ "event": "ordered", "order": "start" });
    let run = fold(&[(0, opened()), (0, start), (4, zone_drawn(0.0, 0.5))]).summary();
    let line = "no-go zone no-go 1, drawn by the operator at 2.0 s: 2.00 m², corners 0.00, 0.50; 1.00, 0.50; 1.00, 2.50; 0.00, 2.50 m";
    assert!(human(&run).contains(line), "{}", human(&run));
    let zone = serde_json::to_value(&run).unwrap()["zones_drawn"][0].clone();
    assert_eq!(
        (&zone["name"], &zone["by"], &zone["t_s"]),
        (&json!("no-go 1"), &json!("operator"), &json!(2.0))
    );
    let early = fold(&[(0, opened()), (0, zone_drawn(0.0, 0.5))]).summary();
    assert!(human(&early).contains("drawn by the operator before the start"), "{}", human(&early));
}
