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
fn a_run_that_made_no_map_is_refused_with_the_remedy() {
    let bench = Bench::new();
    bench.fly(&scenario("goto-single-obstacle.toml"), &[]);
    let run = bench.runs().pop().unwrap();
    let refused = bench.tankops(&["map-of", run.to_str().unwrap(), "-o", "own.toml"]);
    assert!(refused.code == Some(2) && refused.err.contains("mission.kind"), "{refused:?}");
}
