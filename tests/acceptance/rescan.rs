//! A scan with missed areas, a mission for these areas, and the combined result.

use crate::bench::{Bench, Ended, change_journal, journal_text, scenario};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// Straight lanes alone: half the work of planning.
const LANES: [&str; 4] = ["--planner", "tether-safe", "--set", "pattern=straight"];

/// Runs a scan of the round tank with a time limit.
fn half_a_scan(bench: &Bench) -> PathBuf {
    let cover = scenario("cover-circle.toml");
    let flown = bench.fly(&cover, &[&LANES[..], &["--set", "mission.time_limit_s=300"]].concat());
    assert_eq!((flown.code, &flown.json()["outcome"]), (Some(1), &"time_limit".into()), "{flown:?}");
    bench.runs().pop().unwrap()
}

fn rescan(bench: &Bench, runs: &[&Path], output: &str) -> Ended {
    let mut command = bench.command();
    Ended::from(command.arg("rescan").args(runs).args(["-o", output]).output().unwrap())
}

fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

fn tenths(percent: &Value) -> i64 {
    let parts = percent.as_object().unwrap().iter().filter(|(part, _)| *part != "guaranteed");
    parts.map(|(_, value)| (10.0 * value.as_f64().unwrap()).round() as i64).sum()
}

#[test]
fn what_a_mission_missed_is_planned_flown_and_reported_together_with_it() {
    let bench = Bench::new();
    let first = half_a_scan(&bench);
    let made = rescan(&bench, &[&first], "again.toml");
    assert!(made.code == Some(0) && made.out.contains("m² missed in"), "{made:?}");
    let text = std::fs::read_to_string(bench.path().join("again.toml")).unwrap();
    assert!(text.contains("cover-circle-rescan") && text.contains("boxes_m"), "{text}");
    let more = ["--set", "mission.time_limit_s=3600"];
    let planned = bench.tankops(&[&["plan", "again.toml", "--json"][..], &more].concat());
    let plan = planned.json();
    assert!(
        plan["certificate"]["tether_length_max_m"].is_number() && plan["length_m"].as_f64() > Some(50.0),
        "{plan}"
    );
    let flown = bench.fly(Path::new("again.toml"), &more).json();
    assert_eq!((&flown["outcome"], &flown["collisions"]), (&"complete".into(), &0.into()), "{flown}");
    let second = bench.runs().into_iter().find(|run| *run != first).unwrap();

    let [a, b] = [&first, &second].map(|run| run.to_str().unwrap().to_owned());
    let merged = bench.tankops(&["report", &a, &b, "--json"]).json();
    for (listed, run) in merged["runs"].as_array().unwrap().iter().zip([&first, &second]) {
        assert_eq!(listed["run"], run.file_name().unwrap().to_str().unwrap());
        assert_eq!(listed["journal_sha256"], digest(journal_text(run).as_bytes()));
        assert_eq!(listed["recording_sha256"], digest(&std::fs::read(run.join("recording.rrd")).unwrap()));
    }
    let share = |coverage: &Value| coverage["reachable"].as_f64().unwrap();
    let alone: Vec<f64> = (0..2).map(|k| share(&merged["runs"][k]["summary"]["coverage"])).collect();
    let both = share(&merged["coverage"]);
    let gained = alone[0] < 0.5 && both > alone[1] + 0.005 && both > 0.93;
    assert!(gained, "{alone:?} make {both}");
    let floor = &merged["floor"];
    let plates = floor["plates"].as_array().unwrap();
    assert!(plates.len() > 10);
    for part in plates.iter().chain([&floor["whole"], &floor["reachable"]]) {
        assert_eq!(tenths(&part["percent"]), 1000, "{part}");
    }
    let back = bench.tankops(&["report", &b, &a, "--json"]).json();
    assert!((share(&back["coverage"]) - both).abs() < 0.002, "in the other order: {}", back["coverage"]);
    let text = bench.tankops(&["report", &a, &b]).out;
    let recording = format!("sha256 {}", digest(&std::fs::read(second.join("recording.rrd")).unwrap()));
    assert!(text.contains(&recording) && text.contains("critical zone"), "{text}");
}

#[test]
fn runs_that_do_not_fit_together_are_refused_with_the_reason() {
    let bench = Bench::new();
    let first = half_a_scan(&bench);
    let coarse = ["--set", "mission.time_limit_s=60", "--set", "mission.cell_m=0.1"];
    bench.fly(&scenario("cover-circle.toml"), &coarse);
    let second = bench.runs().into_iter().find(|run| *run != first).unwrap();
    let together = bench.tankops(&["report", first.to_str().unwrap(), second.to_str().unwrap()]);
    assert!(together.code == Some(2) && together.err.contains("mission.cell_m"), "{together:?}");
    let twice = bench.tankops(&["report", first.to_str().unwrap(), first.to_str().unwrap()]);
    assert!(twice.code == Some(2) && twice.err.contains("given twice"), "{twice:?}");
    let none = rescan(&bench, &[Path::new("no-such-run")], "again.toml");
    assert!(none.code == Some(2) && none.err.contains("tankops runs"), "{none:?}");
    // The size limit is larger than every missed area.
    let nothing =
        bench.tankops(&["rescan", first.to_str().unwrap(), "-o", "none.toml", "--min-area-m2", "1000"]);
    assert!(
        nothing.code == Some(1) && nothing.out.contains("none.toml not written: no missed area"),
        "{nothing:?}"
    );
    assert!(!bench.path().join("none.toml").exists());
    bench.fly(&scenario("goto-single-obstacle.toml"), &[]);
    let goto = bench.runs().into_iter().find(|run| run.to_str().unwrap().contains("goto")).unwrap();
    let point = rescan(&bench, &[&goto], "again.toml");
    assert!(point.code == Some(2) && point.err.contains("its task is to reach a goal"), "{point:?}");
}

#[test]
fn a_journal_that_was_changed_is_reported_wherever_it_is_read() {
    let bench = Bench::new();
    let run = half_a_scan(&bench);
    let name = run.to_str().unwrap();
    let text = journal_text(&run);
    assert!(!bench.tankops(&["report", name]).out.contains("the report was made from a different journal"));
    change_journal(&run, &(text.replacen("\"collided\":false", "\"collided\":true", 1)));
    for command in [vec!["runs"], vec!["report", name], vec!["export", name, "--rrd", "regenerated.rrd"]] {
        let read = bench.tankops(&command);
        assert!(
            read.code == Some(0) && read.out.contains("the report was made from a different journal"),
            "{read:?}"
        );
    }
}

#[test]
fn the_figures_of_a_run_that_was_cut_off_are_held_to_no_bounds() {
    let bench = Bench::new();
    let run = half_a_scan(&bench);
    let text = journal_text(&run);
    let kept: Vec<&str> = text.lines().take(text.lines().count() / 2).collect();
    change_journal(&run, &(kept.join("\n") + "\n"));
    std::fs::remove_file(run.join("report.json")).unwrap();
    let report = bench.tankops(&["report", run.to_str().unwrap()]);
    assert!(report.out.contains("cut off") && !report.out.contains("not met"), "{report:?}");
}

#[test]
fn a_mission_that_covers_floor_is_refused_a_planner_that_does_not() {
    let bench = Bench::new();
    let cover = scenario("cover-circle.toml");
    let refused = bench.tankops(&["run", cover.to_str().unwrap(), "--planner", "navfn"]);
    let says_why =
        refused.err.contains("does not support coverage missions") && refused.err.contains("tether-safe");
    assert!(refused.code == Some(2) && says_why, "{refused:?}");
}

#[test]
fn a_swath_or_a_box_that_cannot_be_is_refused_when_the_scenario_is_read() {
    let bench = Bench::new();
    let cover = std::fs::read_to_string(scenario("cover-circle.toml")).unwrap();
    let refused = |name: &str, from: &str, to: &str, why: &str| {
        assert!(cover.contains(from));
        let file = bench.file(name, cover.replacen(from, to, 1));
        let answer = bench.tankops(&["plan", file.to_str().unwrap()]);
        assert!(answer.code == Some(2) && answer.err.contains(why), "{answer:?}");
    };
    refused("thin.toml", "overlap_m = 0.1", "overlap_m = 0.597", "parallel lanes");
    let (cells, outside) =
        ("cell_m = 0.05", "boxes_m = [[0.0, 0.0, 1.0, 1.0], [7.0, 0.0, 8.0, 1.0]]\ncell_m = 0.05");
    refused("outside.toml", cells, outside, "box 2 is outside the tank");
}
