//! An engineer who connects a robot: a new adapter, the trial of a vehicle, and the guard by its scan.

use crate::{
    bench::{Bench, Ended, journal, of_kind, scenario, workspace},
    vehicle::{Vehicle, begun},
};
use serde_json::Value;
use std::{path::Path, process::Command};

/// Maximum number of attempts at a trial that must pass on a machine of any speed; a machine that was too busy for a
/// moment may spoil an attempt.
const TRIES: usize = 10;

fn new_vehicle(bench: &Bench, lang: &str) {
    let created = bench.tankops(&["new-vehicle", "my-own", "--lang", lang]);
    assert_eq!(created.code, Some(0), "{created:?}");
}

/// The adapter in Python, after changes to its text.
fn python(bench: &Bench, changes: &[(&str, &str)]) -> String {
    new_vehicle(bench, "python");
    let file = bench.path().join("my-own/adapter.py");
    let mut text = std::fs::read_to_string(&file).unwrap();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    std::fs::write(&file, text).unwrap();
    format!("run:python3 {}", file.display())
}

fn check(bench: &Bench, vehicle: &str, more: &[&str]) -> Ended {
    bench.tankops(&[&["check", "--vehicle", vehicle, "--json"], more].concat())
}

fn verdict<'a>(report: &'a Value, check: &str) -> (&'a str, &'a str) {
    let rows = report["checks"].as_array().unwrap();
    let row = rows.iter().find(|row| row["check"] == check).unwrap_or_else(|| panic!("{check}: {report}"));
    (row["verdict"].as_str().unwrap(), row["says"].as_str().unwrap())
}

/// Tries a vehicle until it passes, and checks that everything was measured.
fn passes(bench: &Bench, vehicle: &str, except: &[&str]) {
    let mut last = None;
    for _ in 0..TRIES {
        let tried = check(bench, vehicle, &["--drive", "--stop-max", "30"]);
        assert!(tried.err.contains("the vehicle now MOVES"), "{tried:?}");
        if tried.code == Some(0) {
            let report = tried.json();
            assert!(report["passed"] == true && report["driven"] == true, "{report}");
            // On a busy machine, the rate of a clock may be too uncertain to be measured.
            let is_as_expected = |row: &Value| {
                let is_open = except.iter().any(|check| row["check"] == *check);
                row["verdict"] == if is_open { "not_measured" } else { "pass" }
            };
            if report["checks"].as_array().unwrap().iter().all(is_as_expected) {
                return;
            }
        }
        last = Some(tried);
    }
    panic!("{last:?}");
}

#[test]
fn a_new_adapter_in_python_passes_the_trial_at_once() {
    let bench = Bench::new();
    let vehicle = python(&bench, &[]);
    passes(&bench, &vehicle, &[]);
    let again = bench.tankops(&["new-vehicle", "my-own"]);
    assert!(again.code == Some(2) && again.err.contains("already exists"), "{again:?}");
    std::os::unix::fs::symlink("nowhere", bench.path().join("linked")).unwrap();
    let dangling = bench.tankops(&["new-vehicle", "linked"]);
    assert!(
        dangling.code == Some(2) && dangling.err.contains("is a link to a folder that does not exist"),
        "{dangling:?}"
    );
}

#[test]
fn a_new_adapter_in_rust_passes_the_trial_at_once() {
    let bench = Bench::new();
    new_vehicle(&bench, "rust");
    let folder = bench.path().join("my-own");
    // The versions that were tested; the machine may be offline.
    std::fs::copy(workspace().join("Cargo.lock"), folder.join("Cargo.lock")).unwrap();
    let made = Command::new(env!("CARGO"))
        .args(["build", "--release", "--offline"])
        .current_dir(&folder)
        .env("CARGO_TARGET_DIR", Path::new(env!("CARGO_TARGET_TMPDIR")).join("adapter"))
        .env_remove("RUSTFLAGS")
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join("adapter/release/my-own");
    passes(&bench, &format!("run:{}", program.display()), &[]);
}

#[test]
fn the_first_drive_of_a_new_adapter_is_completed() {
    let bench = Bench::new();
    let vehicle = python(&bench, &[]);
    let flown = bench.fly(&bench.path().join("my-own/scenario.toml"), &["--vehicle", &vehicle]);
    assert!(flown.code == Some(0) && flown.json()["outcome"] == "complete", "{flown:?}");
}

#[test]
fn without_drive_nothing_moves() {
    let bench = Bench::new();
    let log = bench.path().join("robot.log");
    let vehicle = python(
        &bench,
        &[("os.environ.get(\"ROBOT_LOG\", os.devnull)", &format!("{:?}", log.display().to_string()))],
    );
    let tried = check(&bench, &vehicle, &[]);
    let report = tried.json();
    assert_eq!(verdict(&report, "stop: commands end").0, "not_measured");
    assert!(
        verdict(&report, "frames: ahead").1.contains("`--drive` allows the check to move it"),
        "{report}"
    );
    let rows = std::fs::read_to_string(log).unwrap();
    assert!(rows.lines().count() > 10 && rows.lines().all(|row| row.ends_with(" 0.0 0.0")), "{rows}");
    let table = bench.tankops(&["check", "--vehicle", &vehicle]);
    assert!(table.out.contains("standstill") && table.out.contains("not measured"), "{table:?}");
}

/// Tries a faulty adapter until a check fails, and verifies that it passes the check before and is not driven for the
/// check after it.
fn fails(changes: &[(&str, &str)], [before, fails, after]: [&str; 3], why: &str) {
    let bench = Bench::new();
    let vehicle = python(&bench, changes);
    let mut last = None;
    for _ in 0..TRIES {
        let tried = check(&bench, &vehicle, &["--drive", "--stop-max", "3"]);
        assert_eq!(tried.code, Some(1), "{tried:?}");
        let report = tried.json();
        let (of_check, says) = verdict(&report, fails);
        if of_check == "fail" && says.contains(why) {
            assert_eq!(verdict(&report, before).0, "pass", "{report}");
            let (later, says) = verdict(&report, after);
            assert!(later == "not_measured" && says.contains("was not moved again"), "{report}");
            return;
        }
        last = Some(report);
    }
    panic!("{last:?}");
}

#[test]
fn a_robot_that_turns_the_wrong_way_is_not_driven_on() {
    fails(
        &[("\"turn_rad\": turn}", "\"turn_rad\": -turn}")],
        ["frames: ahead by odometry", "frames: turn by odometry", "stop: message stop"],
        "mirrored",
    );
}

#[test]
fn a_robot_that_keeps_no_lease_is_not_driven_on() {
    fails(
        &[("if now > until:", "if now > until + 1000 * has_adapter:")],
        ["stop: message stop", "stop: commands end", "stop: adapter killed"],
        "keep the lease where the motors are",
    );
}

#[test]
fn an_adapter_that_carries_out_a_command_after_its_lease_is_found_out() {
    fails(
        &[("if late - heard[1] <= lease else \"\"", "")],
        ["stop: commands end", "stop: adapter stopped", "stop: link cut"],
        "ignore a `drive` that is older than its lease",
    );
}

#[test]
fn a_malformed_line_while_driving_ends_the_drive() {
    fails(
        &[(
            "        print(now, v, w, file=log)",
            "        print(now, v, w, file=log) or v and say({\"type\": \"state\"})",
        )],
        ["state", "messages", "frames: turn"],
        "state.",
    );
}

#[test]
fn a_vehicle_behind_a_socket_is_watched_by_a_second_connection() {
    let bench = Bench::new();
    let vehicle = Vehicle::offer(&bench, &scenario("goto-single-obstacle.toml"), &[]);
    passes(&bench, &vehicle.at, &["stop: adapter stopped", "stop: adapter killed"]);
}

#[test]
fn a_trial_needs_an_adapter_and_says_what_is_wrong() {
    let bench = Bench::new();
    for (arguments, why) in [
        (&["check", "--vehicle", "unix:nowhere"][..], "cannot drive the vehicle at unix:nowhere"),
        (&["check", "--vehicle", "run:true"], "it did not introduce the vehicle"),
        (&["check", "--vehicle", "loopback"], "cannot be tried"),
        (&["check", "--vehicle", "unix:a", "--drive", "--speed", "0"], "greater than 0"),
        (&["check", "--drive"], "--vehicle"),
        (&["check"], "FILE"),
        (&["new-vehicle", "My robot"], "is not a valid vehicle name"),
    ] {
        let refused = bench.tankops(arguments);
        assert!(refused.code == Some(2) && refused.err.contains(why), "{why}: {refused:?}");
    }
    let report = check(&bench, "unix:nowhere", &[]).json();
    assert!(report["passed"] == false && report["vehicle"].is_null(), "{report}");
    let (verdict, says) = verdict(&report, "connection");
    assert!(verdict == "fail" && says.contains("cannot drive the vehicle at unix:nowhere"), "{report}");
}

/// The scenario with a column that is in the robot's way but not on the drawing.
fn undrawn(bench: &Bench) -> std::path::PathBuf {
    let text = std::fs::read_to_string(scenario("goto-single-obstacle.toml")).unwrap();
    let text = text.replace("radius_m = 0.3\n", "radius_m = 0.3\nknown = false\n");
    assert!(text.contains("known = false"));
    bench.file("undrawn.toml", text)
}

#[test]
fn a_column_that_only_the_scan_shows_is_found_and_not_hit() {
    let mut last = None;
    for _ in 0..TRIES {
        let bench = Bench::new();
        let file = undrawn(&bench);
        let vehicle = Vehicle::offer(&bench, &file, &["--scanner"]);
        let (child, run) = begun(&bench, &["run", file.to_str().unwrap(), "--vehicle", &vehicle.at]);
        let ended = Ended::from(child.wait_with_output().unwrap());
        let events = journal(&run);
        assert!(of_kind(&events, "sensed").iter().all(|sensed| sensed["readings"]["contact"] == false));
        let held = of_kind(&events, "held");
        let before_something =
            |held: &&Value| held["by"]["guard"]["message"].to_string().contains("the scan shows");
        assert!(!held.iter().any(before_something), "{held:?}");
        // A machine that is busy elsewhere loses the link.
        if ended.code == Some(0) {
            let found = of_kind(&events, "obstacle_found");
            let disc = &found[0]["obstacle"]["shape"]["disc"];
            assert!(found.len() == 1 && (disc["radius_m"].as_f64().unwrap() - 0.3).abs() < 0.03, "{found:?}");
            assert!(held.is_empty());
            bench.prove(&run);
            return;
        }
        last = Some(ended);
    }
    panic!("never complete: {last:?}");
}
