//! A survey, its map for other programs, and the mission that scans the mapped floor.

use crate::bench::{Bench, scenario};
use std::path::{Path, PathBuf};

fn surveyed(bench: &Bench) -> PathBuf {
    let flown = bench.fly(&scenario("survey-tank.toml"), &[]);
    assert_eq!((flown.code, &flown.json()["outcome"]), (Some(0), &"complete".into()), "{flown:?}");
    bench.runs().pop().unwrap()
}

#[test]
fn a_survey_is_verified_and_its_map_is_covered_and_read_by_other_programs() {
    let bench = Bench::new();
    let run = surveyed(&bench);
    let name = run.to_str().unwrap();
    let verified = bench.tankops(&["verify", name]);
    assert_eq!(verified.code, Some(0), "{verified:?}");

    let made = bench.tankops(&["map-of", name, "-o", "own.toml"]);
    assert!(made.code == Some(0) && made.out.contains("9 columns"), "{made:?}");
    let text = std::fs::read_to_string(bench.path().join("own.toml")).unwrap();
    assert!(text.matches("[[obstacles]]").count() == 9 && text.contains("centre +- 0.0"), "{text}");
    let checked = bench.tankops(&["check", "own.toml"]);
    assert_eq!(checked.code, Some(0), "{checked:?}");
    let covered = bench.fly(Path::new("own.toml"), &["--no-record"]).json();
    assert_eq!((&covered["outcome"], &covered["collisions"]), (&"complete".into(), &0.into()), "{covered}");

    let again = bench.tankops(&["map-of", name, "-o", "own.toml"]);
    assert!(again.code == Some(2) && again.err.contains("already exists"), "{again:?}");
    let made = bench.tankops(&["map-of", name, "-o", "own.yaml"]);
    assert_eq!(made.code, Some(0), "{made:?}");
    let read = bench.tankops(&["map", "own.yaml"]);
    assert!(read.code == Some(0) && read.out.contains("floor"), "{read:?}");
    let wrong = bench.tankops(&["map-of", name, "-o", "own.png"]);
    assert!(wrong.code == Some(2) && wrong.err.contains(".yaml"), "{wrong:?}");
}

#[test]
fn a_survey_is_started_in_the_console_and_is_verified() {
    let bench = Bench::new();
    let script = "wait until text \"to start.\" within 1m\nspeed max\nstart\nkey enter\n\
                  wait until screen result within 5m\nassert phase complete\n";
    let file = bench.file("survey.txt", script);
    let survey = scenario("survey-tank.toml");
    let ended = bench.tankops(&["console", survey.to_str().unwrap(), "--script", file.to_str().unwrap()]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    bench.prove(&bench.runs()[0]);
}

/// Runs `survey-tank` with a change, and makes a scenario of its map.
fn map_of(bench: &Bench, from: &str, to: &str) -> crate::bench::Ended {
    let text = std::fs::read_to_string(scenario("survey-tank.toml")).unwrap();
    assert!(text.contains(from), "{from}");
    let changed = bench.file("changed.toml", text.replacen(from, to, 1));
    bench.fly(&changed, &[]);
    let run = bench.runs().pop().unwrap();
    bench.tankops(&["map-of", run.to_str().unwrap(), "-o", "own.toml"])
}

#[test]
fn objects_that_are_not_round_are_on_the_map() {
    let bench = Bench::new();
    let pipe = "[robot]";
    let with_box = "[[obstacles]]\nname = \"sump\"\nkind = \"polygon\"\nknown = false\n\
                    vertices_m = [[-4.6, -1.2], [-3.7, -1.6], [-3.3, -0.7], [-4.2, -0.3]]\n\n[robot]";
    let made = map_of(&bench, pipe, with_box);
    assert_eq!(made.code, Some(0), "{made:?}");
    let checked = bench.tankops(&["check", "own.toml"]);
    assert_eq!(checked.code, Some(0), "{checked:?}");
}

#[test]
fn floor_that_was_not_seen_is_not_free_floor() {
    let bench = Bench::new();
    let made = map_of(&bench, "reel_length_m = ", "reel_length_m = 1.0 #");
    assert!(made.code == Some(2) && made.err.contains("were not seen"), "{made:?}");
    assert!(made.err.contains(".yaml") && !bench.path().join("own.toml").exists(), "{made:?}");
}

#[test]
fn a_survey_whose_journal_was_changed_gives_no_map() {
    let bench = Bench::new();
    let run = surveyed(&bench);
    let (journal, report) = (run.join("events.jsonl.zst"), run.join("report.json"));
    // A journal of another seed beside the report of this one.
    let other = Bench::new();
    other.fly(&scenario("survey-tank.toml"), &["--seed", "2"]);
    std::fs::copy(other.runs().pop().unwrap().join("events.jsonl.zst"), &journal).unwrap();
    assert!(report.exists());
    let refused = bench.tankops(&["map-of", run.to_str().unwrap(), "-o", "own.toml"]);
    assert!(refused.code == Some(2) && refused.err.contains("different journal"), "{refused:?}");
}

#[test]
fn a_run_that_made_no_map_is_refused_with_the_remedy() {
    let bench = Bench::new();
    bench.fly(&scenario("goto-single-obstacle.toml"), &[]);
    let run = bench.runs().pop().unwrap();
    let refused = bench.tankops(&["map-of", run.to_str().unwrap(), "-o", "own.toml"]);
    assert!(refused.code == Some(2) && refused.err.contains("mission.kind"), "{refused:?}");
}
