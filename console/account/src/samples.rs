//! Small runs whose figures can be computed by hand, and a run with every kind of event; for the tests of this crate
//! and of `report`.

#![allow(clippy::unwrap_used, reason = "tests")]

use account::{Fold, Logs, PlannerCalls, Stops, Summary};
use mission::{Event, EventKind, RunOpened};
use serde_json::{Value, json};
use world::{Obstacle, Point, Zone};

/// Builds an event from its JSON; each tick is half a second after the previous one.
pub(crate) fn event(tick: u64, kind: &Value) -> Event {
    let mut event = json!({ "tick": tick, "t_s": tick as f64 * 0.5 });
    event.as_object_mut().unwrap().extend(kind.as_object().unwrap().clone());
    serde_json::from_value(event).unwrap()
}

/// Folds these events.
pub(crate) fn fold(events: &[(u64, Value)]) -> Fold {
    let mut fold = Fold::new();
    for (tick, kind) in events {
        fold.apply(&event(*tick, kind));
    }
    fold
}

/// The true position, and the distance to the nearest solid object.
pub(crate) fn truth(x: f64, y: f64, clearance_m: f64, collided: bool) -> Value {
    let pose = json!({ "position": [x, y], "heading_rad": 0.0 });
    json!({ "event": "truth", "pose": pose, "clearance_m": clearance_m, "collided": collided })
}

/// An estimate whose 95 % ellipse is a circle of `sigma_m` times 2.4477.
pub(crate) fn estimated(x: f64, y: f64, sigma_m: f64) -> Value {
    let v = sigma_m * sigma_m;
    let covariance = json!([v, 0.0, 0.0, v, 0.0, 0.01]);
    json!({ "event": "estimated", "pose": { "position": [x, y], "heading_rad": 0.0, "covariance": covariance } })
}

/// A square tank of 4 m with the robot at its west end and its goal at the east end; cells of 0.5 m, a swath of 1 m.
pub(crate) fn opened() -> Value {
    let corners = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)].map(|(x, y)| Point::new(x, y));
    let world = world::World {
        boundary: world::Boundary::Polygon { vertices: corners.to_vec() },
        obstacles: Vec::new(),
        stations: Vec::new(),
        zones: Vec::new(),
    };
    let floor = world::Floor::new(&world, 0.5, 0.0, 1.0, Point::new(-1.75, 0.25));
    let limits = json!({ "motion": "point", "v_max_m_per_s": 1.0, "w_max_rad_per_s": 1.0, "radius_m": 0.0, "sensing_range_m": 2.0, "acceleration_m_per_s2": 0.5, "tick_s": 0.1 });
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

/// A round tank of 5 m with a column, a robot that keeps 0.45 m from solid objects, and a tool of 0.6 m.
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
    let EventKind::RunOpened(run) = event(0, &run).kind else { panic!("the event must be run_opened") };
    *run
}

/// A planner was selected.
pub(crate) fn chosen(id: &str) -> Value {
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

/// A run with every kind of event.
pub(crate) fn full_run() -> Summary {
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

/// A zone that was drawn during the run: a box of 1 m by 2 m.
pub(crate) fn zone_drawn(x: f64, y: f64) -> Value {
    let vertices = [(x, y), (x + 1.0, y), (x + 1.0, y + 2.0), (x, y + 2.0)].map(|(x, y)| Point::new(x, y));
    let shape = world::Shape::Polygon { vertices: vertices.to_vec() };
    let zone = Zone { name: "no-go 1".into(), kind: world::ZoneKind::NoGo, shape };
    json!({ "event": "zone_drawn", "zone": zone })
}
