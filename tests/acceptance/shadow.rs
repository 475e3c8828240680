//! A planner in shadow: it takes over without a hold, its faults do not affect the mission, and `verify` recomputes
//! the whole run.

use crate::bench::{Bench, Ended, journal, of_kind, scenario};
use serde_json::Value;
use std::path::PathBuf;
#[cfg(target_os = "linux")]
use std::{
    process::{Child, Stdio},
    time::Duration,
};

fn fly(bench: &Bench, name: &str, more: &[&str]) -> (PathBuf, Vec<Value>, Ended) {
    let flown = bench.fly(&scenario(name), more);
    let run = bench.runs().pop().unwrap();
    let events = journal(&run);
    (run, events, flown)
}

/// The ticks in which a command was sent to the robot.
fn driven(events: &[Value]) -> Vec<u64> {
    of_kind(events, "commanded").iter().map(|event| event["tick"].as_u64().unwrap()).collect()
}

/// The maximum numbers of descriptors and children of a process while it runs.
#[cfg(target_os = "linux")]
fn most_held(child: &mut Child) -> (usize, usize) {
    let proc = PathBuf::from(format!("/proc/{}", child.id()));
    let (mut fds, mut children) = (0, 0);
    while child.try_wait().unwrap().is_none() {
        fds = fds.max(std::fs::read_dir(proc.join("fd")).map_or(0, Iterator::count));
        let tasks = std::fs::read_dir(proc.join("task")).map(|tasks| tasks.flatten().collect::<Vec<_>>());
        let of = |task: &std::fs::DirEntry| std::fs::read_to_string(task.path().join("children"));
        let texts = tasks.unwrap_or_default().iter().filter_map(|task| of(task).ok()).collect::<String>();
        children = children.max(texts.split_whitespace().count());
        std::thread::sleep(Duration::from_millis(5));
    }
    (fds, children)
}

/// A slow robot, so that there is time for all promotions.
#[cfg(target_os = "linux")]
#[test]
fn a_thousand_planners_take_over_in_one_mission() {
    let bench = Bench::new();
    let mut command = bench.command();
    command.arg("run").arg(scenario("demo.toml")).args(["--json", "--shadow", "spiral-tangent"]);
    command.args(["--promote-every", "1.2", "--set", "robot.speed_max_m_per_s=0.06"]);
    command.args(["--set", "mission.time_limit_s=4000"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let (fds, children) = most_held(&mut child);
    let flown = Ended::from(child.wait_with_output().unwrap());
    let run = bench.runs().remove(0);
    let events = journal(&run);
    assert!(of_kind(&events, "promoted").len() >= 1000, "{flown:?}");
    assert_eq!(of_kind(&events, "held").len(), 0, "{flown:?}");
    let driven = driven(&events);
    assert!(driven.windows(2).all(|pair| pair[1] == pair[0] + 1), "a command in every tick");
    // There are two workers, one active and one in shadow. Replaced workers take a moment to end, longer on a busy
    // machine. A leak would leave one worker for each of the thousand promotions.
    assert!(fds < 80 && children <= 16, "{fds} descriptors, {children} children");
    bench.prove(&run);
}

#[test]
fn whatever_a_planner_does_in_shadow_the_robot_drives_as_without_it() {
    let plain = Bench::new();
    let (_, alone, _) = fly(&plain, "goto-single-obstacle.toml", &[]);
    let truth = |events: &[Value]| -> Vec<Value> { of_kind(events, "truth").into_iter().cloned().collect() };
    for fault in [
        "panic",
        "segv",
        "exit",
        "hang",
        "sleep",
        "alloc",
        "nan",
        "huge",
        "stack",
        "close_fds",
        "configure_hang",
        "plan_panic",
    ] {
        let bench = Bench::new();
        let set = format!("fault=\"{fault}\"");
        let more = ["--shadow", "faulty", "--shadow-set", &set, "--shadow-set", "at_step=12"];
        let (run, events, flown) = fly(&bench, "goto-single-obstacle.toml", &more);
        assert_eq!(flown.json()["outcome"], "complete", "{fault}: {flown:?}");
        assert_eq!(flown.json()["planner_faults"], 0, "{fault}: {flown:?}");
        assert_eq!(truth(&events), truth(&alone), "{fault}: the robot moves as without a shadow");
        assert_eq!(of_kind(&events, "shadow_ended").len(), 1, "{fault}");
        let named = flown.json()["faults"][0].as_str().unwrap_or_default().to_owned();
        assert!(named.starts_with("shadow: planner faulty "), "{fault}: {named}");
        let text = bench.tankops(&["report", run.to_str().unwrap()]).out;
        assert!(text.contains(&named), "{fault}: {text}");
        assert!(
            of_kind(&events, "held").is_empty() && of_kind(&events, "planner_failed").is_empty(),
            "{fault}"
        );
        let verified = bench.verify(&run, &[]);
        assert_eq!(verified.code, Some(0), "{fault}: {verified:?}");
    }
}

#[test]
fn a_time_between_promotions_that_is_none_is_refused() {
    let bench = Bench::new();
    let demo = scenario("demo.toml");
    for every in ["0", "-3", "nan", "soon"] {
        let refused =
            bench.tankops(&["run", demo.to_str().unwrap(), "--shadow", "apf", "--promote-every", every]);
        assert!(refused.code == Some(2) && refused.err.contains("seconds, more than 0"), "{refused:?}");
    }
}
