//! A mission that is killed (kill -9) loses only its last moment.

use crate::bench::{Bench, journal, scenario};
use std::{
    path::{Path, PathBuf},
    process::Stdio,
    time::{Duration, Instant, SystemTime},
};

#[test]
fn a_killed_run_is_listed_as_crashed_and_its_journal_opens() {
    // The times differ, so that the kill comes at different moments.
    for (seed, wait_ms) in [(11, 50), (12, 170), (13, 390), (14, 610), (15, 830)] {
        let bench = Bench::new();
        // A long mission, because one that ends within a second could not be killed in time.
        let slow = slow_scenario(&bench);
        let killed_at = begin_and_kill(&bench, &slow, seed, |_| {
            std::thread::sleep(Duration::from_millis(wait_ms));
            true
        });

        let run = bench.runs().remove(0);
        let listed = bench.tankops(&["runs", "--json"]).json();
        assert_eq!(listed[0]["end"], "CRASHED", "{listed}");
        let written = |name: &str| run.join(name).metadata().unwrap().modified().unwrap();
        let age = |name: &str| killed_at.duration_since(written(name)).unwrap_or_default();
        assert!(
            age("events.jsonl.zst") <= Duration::from_secs(1),
            "the journal is {:?} old",
            age("events.jsonl.zst")
        );
        assert!(
            age("recording.rrd") <= Duration::from_secs(5),
            "the recording is {:?} old",
            age("recording.rrd")
        );
        assert!(!recording::inspect(&run.join("recording.rrd")).unwrap().entities.is_empty());
        let last_tick = journal(&run).last().unwrap()["tick"].as_i64().unwrap();
        let exported = bench.tankops(&["export", run.to_str().unwrap(), "--rrd", "again.rrd"]);
        assert_eq!(exported.code, Some(0), "{exported:?}");
        let again = recording::inspect(&bench.path().join("again.rrd")).unwrap();
        assert!(
            again.ticks.is_some_and(|(_, last)| last == last_tick || last + 1 == last_tick),
            "{:?}",
            again.ticks
        );
        let verified = bench.tankops(&["verify", run.to_str().unwrap()]);
        assert_eq!(verified.code, Some(0), "{verified:?}");
    }
}

/// Starts a run and kills it when its folder meets a condition; returns the time.
pub(crate) fn begin_and_kill(
    bench: &Bench,
    scenario: &Path,
    seed: u64,
    is_time: impl Fn(&Path) -> bool,
) -> SystemTime {
    let before = bench.runs();
    let mut child = bench
        .command()
        .arg("run")
        .arg(scenario)
        .args(["--seed", &seed.to_string()])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let until = Instant::now() + Duration::from_mins(1);
    let has_begun = |run: &PathBuf| {
        !before.contains(run) && run.join("events.jsonl.zst").metadata().is_ok_and(|file| file.len() > 100)
    };
    while !bench.runs().iter().any(|run| has_begun(run) && is_time(run)) {
        assert!(Instant::now() < until, "the run was never ready to be killed");
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(child.try_wait().unwrap().is_none(), "the mission ended before it could be killed");
    let killed_at = SystemTime::now();
    child.kill().unwrap();
    child.wait().unwrap();
    killed_at
}

pub(crate) fn slow_scenario(bench: &Bench) -> PathBuf {
    let text = std::fs::read_to_string(scenario("spiral-paper.toml")).unwrap();
    // Ten times as many ticks, so that the run takes seconds.
    bench.file("slow.toml", text.replace("tick_s = 0.1", "tick_s = 0.01"))
}
