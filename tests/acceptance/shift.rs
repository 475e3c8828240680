//! The operator's day as a script: a scan with a failed station, a no-go zone and alarms, the handover to the next
//! shift, and a re-scan that completes the floor.

use crate::bench::{Bench, scenario};

#[test]
fn an_operators_day_ends_with_a_complete_floor_a_handover_page_and_two_verified_runs() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path().join("tankops")).unwrap();
    bench.file("tankops/config.toml", "operator = \"lk\"\n");
    let script = bench.file("shift.txt", include_str!("shift.txt"));
    let cover = scenario("cover-circle.toml");
    let words = ["console", cover.to_str().unwrap(), "--script", script.to_str().unwrap()];
    let ended = bench.tankops(&words);
    assert_eq!(ended.code, Some(0), "{ended:?}");

    let page = std::fs::read_to_string(bench.path().join("handover.md")).unwrap();
    for line in [
        "# Handover: cover-circle",
        "HELD by operator",
        "Operator: lk",
        "station C excluded, since",
        "reason: pump noise",
        "exclude station C by lk",
        "no-go 1: box 2.50, 1.50 to 3.00, 2.00 m",
        "held by operator",
        "of the reachable floor",
    ] {
        assert!(page.contains(line), "{line} in {page}");
    }

    let runs = bench.runs();
    assert_eq!(runs.len(), 2, "{runs:?}");
    let names: Vec<&str> = runs.iter().map(|run| run.to_str().unwrap()).collect();
    let both = bench.tankops(&["report", names[0], names[1], "--json"]).json();
    let share = both["coverage"]["reachable"].as_f64().unwrap();
    assert!(share > 0.95, "{}", both["coverage"]);
}
