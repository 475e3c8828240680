//! A channel of the instrument that is dead for a minute.

use crate::bench::{Bench, scenario};
use serde_json::Value;
use std::fs;

/// The account of the floor in the report of the newest run.
fn floor(bench: &Bench, name: &str) -> Value {
    assert_eq!(bench.tankops(&["report", name, "-o", "r.json", "--force"]).code, Some(0));
    serde_json::from_str(&fs::read_to_string(bench.path().join("r.json")).unwrap()).unwrap()
}

#[test]
fn floor_under_a_dead_channel_is_missed_with_its_reason_in_every_output() {
    let bench = Bench::new();
    let flown = bench.fly(&scenario("inspect-dead-channel.toml"), &[]);
    assert_eq!(flown.code, Some(0), "{flown:?}");
    let run = bench.runs().pop().unwrap();
    bench.prove(&run);
    let name = run.file_name().unwrap().to_string_lossy().into_owned();
    let account = &flown.json()["floor"];
    let missed = account["missed"].as_array().unwrap();
    let dead: Vec<&Value> = missed.iter().filter(|area| area["reason"] == "dead_channel").collect();
    assert!(!dead.is_empty(), "{missed:?}");
    let area_m2: f64 = dead.iter().map(|area| area["area_m2"].as_f64().unwrap()).sum();
    // A strip of 15 mm takes the cells of 50 mm that it touches, on at most 60 s at 0.4 m/s.
    assert!((0.3..60.0 * 0.4 * (0.015 + 2.0 * 0.0354)).contains(&area_m2), "{area_m2} m²");
    let first = |area: &&Value| area["causes"][0]["measure"]["near"] == "channel 20";
    assert!(dead.iter().all(first), "{dead:?}");
    let percent = &account["whole"]["percent"];
    let sum: f64 = ["scanned", "missed", "unreachable", "margin", "untestable"]
        .iter()
        .map(|key| percent[key].as_f64().unwrap_or(0.0))
        .sum();
    assert!((sum - 100.0).abs() < 1e-9, "{percent}");
    // The dead channel has no readings while it is dead, and the others have some.
    let mut of_dead = 0;
    let mut of_next = 0;
    recording::each_reading(&run.join(recording::READINGS_FILE), |reading: account::Reading| {
        let is_within = (90.2..149.8).contains(&reading.t_s);
        of_dead += u32::from(is_within && reading.channel == 20);
        of_next += u32::from(is_within && reading.channel == 21);
    })
    .unwrap();
    assert!(of_dead == 0 && of_next > 1000, "{of_dead} {of_next}");
    let document = floor(&bench, &name).to_string();
    assert!(document.contains("passed while channel 20 was dead"), "the report states the reason");
    for file in ["r.html", "r.csv", "r.geojson"] {
        assert_eq!(bench.tankops(&["report", &name, "-o", file]).code, Some(0), "{file}");
    }
    let html = fs::read_to_string(bench.path().join("r.html")).unwrap();
    assert!(html.contains("while channel 20 was dead"));
    let geojson = fs::read_to_string(bench.path().join("r.geojson")).unwrap();
    assert!(geojson.contains("while channel 20 was dead"));
    // With the channel alive, the same mission misses nothing for this reason.
    let text = fs::read_to_string(scenario("inspect-dead-channel.toml")).unwrap();
    let line = text.lines().find(|line| line.starts_with("dead = ")).unwrap();
    let alive = bench.file("alive.toml", text.replace(line, ""));
    let alive = bench.fly(&alive, &[]).json();
    let missed = alive["floor"]["missed"].as_array().unwrap();
    assert!(missed.iter().all(|area| area["reason"] != "dead_channel"), "{missed:?}");
    let reachable = |run: &Value| run["coverage"]["reachable"].as_f64().unwrap();
    assert!(reachable(&alive) > reachable(&flown.json()) + 0.005);
}

#[test]
fn dead_channels_that_cannot_be_are_refused_by_line_and_key() {
    let bench = Bench::new();
    let text = fs::read_to_string(scenario("inspect-dead-channel.toml")).unwrap();
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from));
        let file = bench.file("bad.toml", text.replace(from, to));
        let ended = bench.fly(&file, &[]);
        assert_eq!(ended.code, Some(2), "{ended:?}");
        ended.err
    };
    let why = refused("channel = 20", "channel = 40");
    assert!(why.contains("0 to 39: [instrument] has 40 channels"), "{why}");
    let why = refused("to_s = 150.0", "to_s = 80.0");
    assert!(why.contains("greater than from_s, 90 s"), "{why}");
    let why = refused("channels = 40\n", "");
    assert!(why.contains("add channels = ..."), "{why}");
}
