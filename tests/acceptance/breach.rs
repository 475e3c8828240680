//! The drill of the operator guide: a no-go zone over the robot is a hold with a critical alarm, and the robot can be driven
//! out of the zone.

use crate::bench::{Bench, scenario};

#[test]
fn a_zone_over_the_robot_is_a_hold_with_a_critical_alarm_and_the_robot_drives_out_of_it() {
    let bench = Bench::new();
    let script = bench.file("breach.txt", include_str!("breach.txt"));
    let cover = scenario("cover-circle.toml");
    let words = ["console", cover.to_str().unwrap(), "--script", script.to_str().unwrap()];
    let ended = bench.tankops(&words);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let run = bench.runs().remove(0);
    let events = bench.tankops(&["events", run.to_str().unwrap()]).out;
    let held = r#""event":"held","by":{"zone_breached":{"zone":"no-go 1"}}"#;
    let at = |text: &str| events.find(text).unwrap_or_else(|| panic!("{text} in {events}"));
    assert!(at(held) < at(r#""event":"zone_left","zone":"no-go 1""#), "held in the zone, then out of it");
}
