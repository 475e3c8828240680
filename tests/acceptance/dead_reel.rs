//! A reel that has stopped, or is far too weak: the robot comes back beside its tether, and never drives over it.

use crate::bench::{Bench, scenario};
use std::path::Path;

/// Flies a shipped scenario with a setting by a script; returns the events.
fn flown(name: &str, setting: &str, script: &str) -> String {
    let events = flown_in(&Bench::new(), &scenario(name), setting, script);
    assert_eq!(events.matches(r#""order":"drive_back""#).count(), 1, "{name}");
    events
}

/// Flies a scenario of a file; the robot must never be over its own tether.
fn flown_in(bench: &Bench, tank: &Path, setting: &str, script: &str) -> String {
    let name = tank.display();
    let script = bench.file("script.txt", script);
    let words = ["console", tank.to_str().unwrap(), "--set", setting, "--script", script.to_str().unwrap()];
    let ended = bench.tankops(&words);
    assert_eq!(ended.code, Some(0), "{name}: {ended:?}");
    let run = bench.runs().remove(0);
    let events = bench.tankops(&["events", run.to_str().unwrap()]).out;
    assert!(
        events.contains(r#""under_hull":false"#) && !events.contains(r#""under_hull":true"#),
        "{name}: over its own tether"
    );
    events
}

#[test]
fn with_a_reel_that_has_stopped_the_robot_drives_back_beside_its_tether_by_one_order() {
    let script = include_str!("dead_reel.txt");
    let events = flown("cover-heavy-cable.toml", "tether.reel_fails_at_s=60", script);
    assert_eq!(events.matches(r#""event":"held""#).count(), 1, "held once, for the slack");
    assert!(events.contains("robot is back beside the anchor"), "{events}");
}

/// Tether that the reel takes up moves across the floor, so the way beside it has to be found again.
#[test]
fn a_weak_reel_that_takes_tether_up_on_the_way_back_holds_the_robot_with_the_reason() {
    let script = include_str!("weak_reel.txt");
    let events = flown("tether-weak-reel.toml", "tether.allow_uncertified=true", script);
    assert!(events.contains("the reel takes the tether up again"), "{events}");
    assert!(events.contains("wait until it rests, then order the drive back again"), "{events}");
}

/// The planner assumes a reel that works, so the plan after the resume leads over the tether.
#[test]
fn a_task_that_is_taken_up_again_with_a_stopped_reel_is_held_before_the_robot_drives_over_its_tether() {
    let bench = Bench::new();
    let tank = bench.file("tank.toml", include_str!("stopped_reel.toml"));
    let script = include_str!("stopped_reel.txt");
    let events = flown_in(&bench, &tank, "tether.reel_fails_at_s=80", script);
    assert!(events.contains("hull about to reach its own tether"), "{events}");
}
