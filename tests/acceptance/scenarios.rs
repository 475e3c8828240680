//! Every shipped scenario meets its own `[expect]`, and gives the same run when it is repeated.

use crate::bench::{Bench, journal_text, scenario, workspace};

/// Maximum distance between the end of a run into a trap and the end of its plan, metres.
const STOP_M: f64 = 0.2;

fn shipped() -> Vec<std::path::PathBuf> {
    let folders = ["scenarios", "scenarios/papers"].map(|folder| workspace().join(folder));
    let entries = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap());
    let mut files: Vec<_> =
        entries.map(|e| e.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "toml")).collect();
    files.sort();
    assert!(files.len() >= 3, "{files:?}");
    files
}

#[test]
fn every_shipped_scenario_meets_its_expectations() {
    let bench = Bench::new();
    for file in shipped() {
        let flown = bench.fly(&file, &["--no-record"]);
        let report = flown.json();
        assert_eq!(report["violations"], serde_json::json!([]), "{}: {flown:?}", file.display());
        // Some scenarios exist to show other outcomes.
        let code = i32::from(report["outcome"] != "complete");
        assert_eq!(flown.code, Some(code), "{}: {flown:?}", file.display());
    }
}

#[test]
fn a_complete_mission_that_does_not_keep_a_bound_does_not_exit_as_one_that_does() {
    let bench = Bench::new();
    let text = std::fs::read_to_string(scenario("goto-single-obstacle.toml")).unwrap();
    let (before, _) = text.split_once("[expect]").unwrap();
    for (bound, code) in [("mission_time_max_s = 1000.0", 0), ("mission_time_max_s = 1.0", 1)] {
        let bounded = bench.file("bounded.toml", format!("{before}[expect]\n{bound}\n"));
        let flown = bench.fly(&bounded, &["--no-record"]);
        assert_eq!(flown.json()["outcome"], "complete", "{flown:?}");
        assert_eq!(flown.code, Some(code), "{bound}: {flown:?}");
    }
}

#[test]
fn a_plan_that_winds_the_tether_is_refused_with_the_reason_unless_the_scenario_says_otherwise() {
    let bench = Bench::new();
    let refused = bench.fly(&scenario("tether-refused.toml"), &["--no-record"]).json();
    let reason = refused["reason"].as_str().unwrap();
    assert!(reason.contains("not safe for the tether") && reason.contains("column C1"), "{reason}");
    assert_eq!(refused["tether"]["entangled"], false);
    let wound = bench.fly(&scenario("tether-wound.toml"), &["--no-record"]).json();
    assert_eq!((&wound["outcome"], &wound["tether"]["entangled"]), (&"entangled".into(), &true.into()));
    assert!(wound["reason"].as_str().unwrap().contains("wraps"), "{wound}");
}

#[test]
fn a_plan_that_needs_more_pull_than_the_reel_has_is_refused_with_the_remedies() {
    let bench = Bench::new();
    let refused = bench.fly(&scenario("tether-weak-reel.toml"), &["--no-record"]);
    let reason = refused.json()["reason"].as_str().unwrap().to_owned();
    assert!(reason.contains("the reel pulls 6.0 N") && reason.contains("stronger reel"), "{reason}");
    assert_eq!(refused.json()["violations"], serde_json::json!([]), "{refused:?}");
}

#[test]
fn a_heavy_cable_is_taken_up_and_a_reel_that_stops_holds_the_robot_before_it_drives_over_its_cable() {
    let bench = Bench::new();
    let heavy = scenario("cover-heavy-cable.toml");
    let flown = bench.fly(&heavy, &["--no-record"]).json();
    let tether = &flown["tether"];
    assert_eq!((&tether["over_own"], &tether["snags"]), (&0.into(), &0.into()), "{tether}");
    let stopped = bench.fly(&heavy, &["--no-record", "--set", "tether.reel_fails_at_s=60"]).json();
    let reason = stopped["reason"].as_str().unwrap();
    assert!(reason.contains("hull about to reach its own tether: the reel has stopped"), "{reason}");
    assert_eq!(stopped["tether"]["over_own"], 0, "{stopped}");
    let weak = ["--no-record", "--set", "tether.allow_uncertified=true"];
    let weak = bench.fly(&scenario("tether-weak-reel.toml"), &weak).json();
    assert!(weak["reason"].as_str().unwrap().contains("reel does not take the tether up"), "{weak}");
    assert_eq!(weak["tether"]["over_own"], 0, "{weak}");
}

#[test]
fn a_cable_that_tears_ends_an_unattended_mission_with_the_reason_and_is_in_the_report() {
    let bench = Bench::new();
    let torn = bench.fly(&scenario("tether-breaks.toml"), &["--no-record"]).json();
    let reason = torn["reason"].as_str().unwrap();
    assert!(reason.contains("tether broken: ") && reason.contains(" m are off the reel"), "{reason}");
    let found_s = torn["tether"]["broken_at_s"].as_f64().unwrap();
    assert!((200.0..220.0).contains(&found_s), "{torn}");
    assert_eq!(
        (&torn["violations"], &torn["tether"]["snags"]),
        (&serde_json::json!([]), &0.into()),
        "{torn}"
    );
    // A pull that the cable does not bear tears it as well; the plan pulls at the robot with at least the pull of the reel.
    let weak = ["--no-record", "--set", "tether.breaks_at_n=20", "--set", "tether.breaks_at_s=3000"];
    let weak = bench.fly(&scenario("tether-breaks.toml"), &weak).json();
    assert!(weak["reason"].as_str().unwrap().contains("tether broken: "), "{weak}");
}

#[test]
fn the_guide_to_cable_and_reel_has_the_pulls_that_the_program_computes() {
    let bench = Bench::new();
    let guide = std::fs::read_to_string(workspace().join("console/docs/operator-guide.md")).unwrap();
    let rows: Vec<Vec<&str>> = guide
        .lines()
        .filter(|line| line.starts_with("| `cover-") && line.contains("kg/m"))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    assert!(rows.len() >= 7, "{rows:?}");
    for row in rows {
        let [name, cable, friction, needed, reel] = row[..] else { panic!("{row:?}") };
        let text = std::fs::read_to_string(scenario(&format!("{}.toml", name.trim_matches('`')))).unwrap();
        let mass = cable.strip_suffix(" kg/m").unwrap();
        let keys = format!(
            "[tether]\nreel_pull_n = 1000.0\nmass_kg_per_m = {mass}\nfloor_friction = {friction}\nfriction = {friction}\n"
        );
        let changed = bench.file("cable.toml", text.replacen("[tether]\n", &keys, 1));
        let plan = bench.tankops(&["plan", changed.to_str().unwrap(), "--json"]).json();
        let needed_n = plan["certificate"]["pull"]["needed_n"].as_f64().unwrap();
        assert_eq!(format!("{needed_n:.1} N"), needed, "{row:?}");
        let reel_n: f64 = reel.strip_suffix(" N").unwrap().parse().unwrap();
        assert!((0.77..=0.8).contains(&(needed_n / reel_n)), "{row:?}");
    }
}

#[test]
fn two_runs_of_one_seed_have_equal_journals() {
    let bench = Bench::new();
    let demo = scenario("demo.toml");
    let (first, second) = (bench.fly(&demo, &[]).json(), bench.fly(&demo, &[]).json());
    assert_eq!(first["events_sha256"], second["events_sha256"]);
    let runs = bench.runs();
    assert!(journal_text(&runs[0]) == journal_text(&runs[1]), "journals differ");
    let other = bench.fly(&demo, &["--seed", "77"]).json();
    assert_ne!(first["events_sha256"], other["events_sha256"]);
}

#[test]
fn the_demo_shows_what_it_is_there_for() {
    let bench = Bench::new();
    let report = bench.fly(&scenario("demo.toml"), &[]).json();
    assert_eq!(report["outcome"], "complete");
    assert_eq!(report["collisions"], 0);
    assert!(report["obstacles_found"].as_u64() >= Some(1), "{report}");
    assert!((100.0..400.0).contains(&report["mission_time_s"].as_f64().unwrap()), "{report}");
    assert!(report["clearance_min_m"].as_f64().unwrap() > 0.0, "{report}");
}

/// Xu et al. 2022, Table 2: the classical field stops in the trap.
#[test]
fn the_classical_field_ends_its_flight_where_its_plan_ends() {
    let bench = Bench::new();
    let file = scenario("papers/xu-table2.toml");
    let gains = ["--set", "k_rep=10", "--set", "rho_0_m=2", "--set", "wall_gain=0", "--planner", "apf"];
    let planned = bench.command().args(["plan", "--json"]).arg(&file).args(gains).output().unwrap();
    let plan: serde_json::Value = serde_json::from_slice(&planned.stdout).unwrap();
    let stop = plan["path"].as_array().unwrap().last().unwrap();
    assert_eq!(bench.fly(&file, &gains).json()["outcome"], "stuck");
    let run = &bench.runs()[0];
    let truth = bench.tankops(&["events", run.to_str().unwrap(), "--kind", "truth"]).out;
    let last: serde_json::Value = serde_json::from_str(truth.lines().last().unwrap()).unwrap();
    let off =
        |axis: usize| (last["pose"]["position"][axis].as_f64().unwrap() - stop[axis].as_f64().unwrap()).abs();
    assert!(off(0).hypot(off(1)) < STOP_M, "{stop} {last}");
}
