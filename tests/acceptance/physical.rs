//! Missions with a physical cable: they repeat, are verified, rescanned and repaired, and forecasts and planners in shadow work
//! with them, as with a taut cable.

use crate::bench::{Bench, journal, journal_text, of_kind, scenario};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A small tank with a square column, a round one, and one that is not on the drawing and lies on a lane.
const OWN: &str = r#"name = "own-cable"
seed = 3
[tank]
radius_m = 3.5
[[obstacles]]
name = "square"
kind = "box"
center_m = [0.8, 0.6]
size_m = [0.4, 0.4]
[[obstacles]]
name = "round"
kind = "circle"
center_m = [-1.2, 0.9]
radius_m = 0.2
[[obstacles]]
name = "unseen"
kind = "circle"
center_m = [0.0, 1.5]
radius_m = 0.15
known = false
[robot]
start_m = [0.0, -3.0]
start_heading_deg = 90.0
radius_m = 0.2
[ae]
stations = [
    { name = "A", at_m = [3.5, 0.0] },
    { name = "B", at_m = [-1.75, 3.03] },
    { name = "C", at_m = [-1.75, -3.03] },
]
noise = { model = "uniform", ratio = 0.005 }
[tether]
model = "physical"
reel_pull_n = 12.0
mass_kg_per_m = 0.2
reel_length_m = 12.0
[mission]
kind = "cover"
swath_m = 0.6
overlap_m = 0.1
clearance_m = 0.05
cell_m = 0.05
tolerance_m = 0.2
[planner]
id = "tether-safe"
"#;

/// The shipped scenario with a heavy cable, and our own.
fn scenarios(bench: &Bench) -> [PathBuf; 2] {
    [scenario("cover-heavy-cable.toml"), bench.file("own.toml", OWN)]
}

/// Checks that the mission is complete without snags or crossings of the cable, and that the line of the cable is recorded.
fn is_whole(flown: &Value, run: &Path) {
    let events = journal(run);
    assert_eq!(flown["outcome"], "complete", "{flown}");
    assert_eq!((&flown["tether"]["over_own"], &flown["tether"]["snags"]), (&0.into(), &0.into()), "{flown}");
    let truths = of_kind(&events, "tether_truth");
    assert!(truths.iter().any(|truth| truth["lies"]["line"].is_array()), "{}", run.display());
}

#[test]
fn a_mission_with_a_physical_cable_repeats_with_a_shadow_and_with_repairs_and_is_verified() {
    for index in 0..2 {
        let bench = Bench::new();
        let file = &scenarios(&bench)[index];
        let more = ["--set", "mission.better_plan=\"take\"", "--shadow", "hull-partition"];
        let flown = bench.fly(file, &more).json();
        let run = bench.runs().pop().unwrap();
        is_whole(&flown, &run);
        let events = journal(&run);
        let reasons: Vec<&str> =
            of_kind(&events, "planned").iter().filter_map(|plan| plan["reason"].as_str()).collect();
        assert!(reasons.len() > 1, "no repair: {reasons:?}");
        // The small tank is scanned before a better plan would save time.
        assert_eq!(of_kind(&events, "better_planned").is_empty(), index == 1, "{}", file.display());
        assert!(!of_kind(&events, "shadowed").is_empty(), "{}", file.display());
        bench.prove(&run);
        let again = bench.fly(file, &more).json();
        assert_eq!(flown["events_sha256"], again["events_sha256"]);
        let [first, second] = [0, 1].map(|k| journal_text(&bench.runs()[k]));
        assert!(first == second, "journals differ");
    }
}

#[test]
fn what_a_mission_with_a_physical_cable_missed_is_scanned_again() {
    for index in 0..2 {
        let bench = Bench::new();
        let file = &scenarios(&bench)[index];
        let cut_off = bench.fly(file, &["--set", "mission.time_limit_s=120"]).json();
        assert_eq!(cut_off["outcome"], "time_limit", "{cut_off}");
        let first = bench.runs().pop().unwrap();
        let made = bench.tankops(&["rescan", first.to_str().unwrap(), "-o", "again.toml"]);
        assert_eq!(made.code, Some(0), "{made:?}");
        let text = std::fs::read_to_string(bench.path().join("again.toml")).unwrap();
        assert!(text.contains("physical"), "{text}");
        let flown = bench.fly(Path::new("again.toml"), &["--set", "mission.time_limit_s=3600"]).json();
        let second = bench.runs().into_iter().find(|run| *run != first).unwrap();
        is_whole(&flown, &second);
        bench.prove(&second);
    }
}

#[test]
fn a_forecast_of_a_mission_with_a_physical_cable_comes_to_an_end() {
    for index in 0..2 {
        let bench = Bench::new();
        let file = scenarios(&bench)[index].to_str().unwrap().to_owned();
        let script = "speed max\nstart\nkey enter\nwait until coverage >= 10 within 2m\nhold\nwait until phase held\nwhat-if\n\
                      wait until text \"COMPLETE\" within 4m\nassert text \"certified\"\n";
        let script = bench.file("what-if.txt", script);
        let ended = bench.tankops(&["console", &file, "--script", script.to_str().unwrap()]);
        assert_eq!(ended.code, Some(0), "{ended:?}");
        bench.prove(&bench.runs()[0]);
    }
}
