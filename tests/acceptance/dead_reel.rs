//! A reel that has stopped, or is far too weak: the robot comes back beside its tether by one order.

use crate::bench::{Bench, scenario};

#[test]
fn with_a_reel_that_does_not_take_up_the_robot_drives_back_beside_its_tether_by_one_order() {
    for (name, setting) in [
        ("cover-heavy-cable.toml", "tether.reel_fails_at_s=60"),
        ("tether-weak-reel.toml", "tether.allow_uncertified=true"),
    ] {
        let bench = Bench::new();
        let script = bench.file("dead_reel.txt", include_str!("dead_reel.txt"));
        let tank = scenario(name);
        let words =
            ["console", tank.to_str().unwrap(), "--set", setting, "--script", script.to_str().unwrap()];
        let ended = bench.tankops(&words);
        assert_eq!(ended.code, Some(0), "{name}: {ended:?}");
        let run = bench.runs().remove(0);
        let events = bench.tankops(&["events", run.to_str().unwrap()]).out;
        assert_eq!(events.matches(r#""event":"held""#).count(), 1, "{name}: held once, for the slack");
        assert_eq!(events.matches(r#""order":"drive_back""#).count(), 1, "{name}");
        assert!(events.contains("robot is back beside the anchor"), "{name}");
        assert!(
            events.contains(r#""under_hull":false"#) && !events.contains(r#""under_hull":true"#),
            "{name}"
        );
    }
}
