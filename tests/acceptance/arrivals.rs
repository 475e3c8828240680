//! Answers that arrive late, are cut short or never arrive: the run continues or ends, and can still be verified.

use crate::bench::{Bench, Ended, first_of, journal, of_kind, scenario};
use crate::looking_on::Console;
use rustix::process::{Pid, Signal, kill_process};
use std::{
    path::PathBuf,
    process::{Child, Stdio},
    time::{Duration, Instant},
};

const PATIENCE: Duration = Duration::from_mins(1);

/// A mission in progress with the misbehaving planner.
struct Flying {
    bench: Bench,
    child: Child,
}

impl Flying {
    fn start(settings: &[&str], more: &[&str]) -> Self {
        let bench = Bench::new();
        let mut command = bench.command();
        command.arg("run").arg(scenario("goto-single-obstacle.toml")).args(["--json", "--planner", "faulty"]);
        for setting in settings {
            command.args(["--set", setting]);
        }
        command.args(more).stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = command.spawn().unwrap();
        let flying = Self { bench, child };
        // Before that, workers only list the contents of plugins.
        flying.until("the journal", |flying| {
            let begun =
                |run: &PathBuf| run.join("events.jsonl.zst").metadata().is_ok_and(|file| file.len() > 100);
            flying.bench.runs().iter().any(begun)
        });
        flying
    }

    fn until(&self, what: &str, is_so: impl Fn(&Self) -> bool) {
        let until = Instant::now() + PATIENCE;
        while !is_so(self) {
            assert!(Instant::now() < until, "timed out waiting for {what}");
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    fn workers(&self) -> Vec<i32> {
        workers_of(self.child.id())
    }

    /// Sends a signal to the active planner.
    fn signal_worker(&self, signal: Signal) -> i32 {
        self.until("a worker", |flying| !flying.workers().is_empty());
        let worker = self.workers()[0];
        signal_it(worker, signal);
        worker
    }

    fn end(self) -> (Bench, Ended) {
        let output = self.child.wait_with_output().unwrap();
        (self.bench, Ended::from(output))
    }
}

/// Processes of planners that a process has started.
fn workers_of(process: u32) -> Vec<i32> {
    let threads = std::fs::read_dir(format!("/proc/{process}/task")).into_iter().flatten();
    let children =
        threads.filter_map(|thread| std::fs::read_to_string(thread.unwrap().path().join("children")).ok());
    let pids: Vec<i32> = children
        .flat_map(|pids| pids.split_whitespace().map(|pid| pid.parse().unwrap()).collect::<Vec<_>>())
        .collect();
    pids.into_iter().filter(|pid| is_worker(*pid)).collect()
}

fn is_worker(pid: i32) -> bool {
    let arguments = std::fs::read(format!("/proc/{pid}/cmdline")).unwrap_or_default();
    arguments.split(|byte| *byte == 0).nth(1) == Some(b"worker")
}

fn signal_it(worker: i32, signal: Signal) {
    assert!(worker > 1 && is_worker(worker), "{worker} is not a worker");
    kill_process(Pid::from_raw(worker).unwrap(), signal).unwrap();
}

/// Interferes with the active planner's process after some time, and verifies the run.
fn interfere(signal: Signal, after_ms: u64, fallback: bool) {
    let settings = ["fault=dawdle", "at_step=0", "planner.fallback.id=apf"];
    let flying = Flying::start(if fallback { &settings } else { &settings[..2] }, &[]);
    std::thread::sleep(Duration::from_millis(after_ms));
    flying.signal_worker(signal);
    let (bench, flown) = flying.end();
    let what = format!("{signal:?} after {after_ms} ms, {fallback}: {flown:?}");
    let report = flown.json();
    assert_eq!(report["planner_faults"], 1, "{what}");
    let run = bench.runs().remove(0);
    let events = journal(&run);
    let failed = first_of(&events, "planner_failed").unwrap();
    let took_over = events[failed..].iter().any(|event| event["choice"]["id"] == "apf");
    assert_eq!(took_over, fallback, "{what}");
    assert!(fallback || report["outcome"] == "aborted", "{what}");
    bench.prove(&run);
    let verified = bench.verify(&run, &[]);
    assert!(
        verified.out.contains("external or timing faults of planner faulty, taken from the journal: 1"),
        "{verified:?}"
    );
}

#[test]
fn a_run_whose_planner_is_killed_from_outside_is_proven() {
    interfere(Signal::KILL, 0, true);
    interfere(Signal::KILL, 300, false);
    interfere(Signal::KILL, 700, true);
}

#[test]
fn a_run_whose_planner_is_stopped_for_good_is_proven() {
    interfere(Signal::STOP, 100, false);
    interfere(Signal::STOP, 500, true);
}

#[test]
fn a_run_whose_planner_crashes_is_proven() {
    interfere(Signal::ABORT, 200, true);
    interfere(Signal::ILL, 400, false);
}

#[test]
fn a_planner_that_is_stopped_and_continued_has_no_fault() {
    let flying = Flying::start(&["fault=dawdle", "at_step=0"], &[]);
    std::thread::sleep(Duration::from_millis(200));
    let worker = flying.signal_worker(Signal::STOP);
    std::thread::sleep(Duration::from_millis(400));
    signal_it(worker, Signal::CONT);
    let (bench, flown) = flying.end();
    assert_eq!(flown.json()["planner_faults"], 0, "{flown:?}");
    bench.prove(&bench.runs()[0]);
}

#[test]
fn a_plan_that_is_cut_short_by_an_interrupt_ends_the_mission_at_once_and_is_proven() {
    for signal in [Signal::INT, Signal::TERM, Signal::QUIT] {
        let flying = Flying::start(&["fault=plan_hang"], &[]);
        flying.until("the worker", |flying| !flying.workers().is_empty());
        std::thread::sleep(Duration::from_millis(500));
        // A stray signal has no effect.
        kill_process(Pid::from_child(&flying.child), Signal::USR1).unwrap();
        kill_process(Pid::from_child(&flying.child), signal).unwrap();
        let (bench, flown) = flying.end();
        assert_eq!(flown.code, Some(1), "{flown:?}");
        assert_eq!(flown.json()["outcome"], "aborted", "{flown:?}");
        let run = bench.runs().remove(0);
        let events = journal(&run);
        let kinds = ["planned", "planner_failed"].map(|kind| first_of(&events, kind));
        assert_eq!(kinds, [None, None], "the plan was not cut short");
        assert_eq!(events.last().unwrap()["reason"], "ended by a signal to the process");
        bench.prove(&run);
    }
}

#[test]
fn a_plan_that_ran_out_of_time_is_proven_without_waiting_again() {
    let began = Instant::now();
    let flying = Flying::start(&["fault=plan_hang", "planner.fallback.id=apf"], &[]);
    let (bench, flown) = flying.end();
    let flight = began.elapsed();
    assert_eq!(flown.json()["outcome"], "complete", "{flown:?}");
    let run = bench.runs().remove(0);
    let events = journal(&run);
    assert_eq!(of_kind(&events, "planner_failed")[0]["fault"]["cause"], "hung");
    for more in [&[][..], &["--from-journal"]] {
        let began = Instant::now();
        let verified = bench.verify(&run, more);
        let took = began.elapsed();
        assert!(verified.code == Some(0) && verified.out.contains("equal: "), "{verified:?}");
        // The mission waited for the plan's whole budget of 5 s.
        assert!(took < flight, "verify took {took:?}, the flight {flight:?}");
    }
}

#[test]
fn with_live_deadlines_a_slow_step_is_late_and_no_fault() {
    let flying = Flying::start(&["fault=nap", "at_step=12"], &["--live-deadlines"]);
    let (bench, flown) = flying.end();
    assert_eq!(flown.json()["planner_faults"], 0, "{flown:?}");
    let run = bench.runs().remove(0);
    let events = journal(&run);
    let late = of_kind(&events, "planner_late");
    assert!(
        !late.is_empty() && late[0]["planner"] == "faulty" && late[0]["ticks"].as_u64() >= Some(1),
        "{late:?}"
    );
    assert!(of_kind(&events, "planner_failed").is_empty());
    bench.prove(&run);
}

#[test]
fn with_live_deadlines_a_slow_plan_arrives_in_a_later_tick() {
    let flying = Flying::start(&["fault=plan_nap"], &["--live-deadlines"]);
    let (bench, flown) = flying.end();
    assert_eq!(flown.json()["planner_faults"], 0, "{flown:?}");
    let run = bench.runs().remove(0);
    let events = journal(&run);
    let planned = of_kind(&events, "planned");
    assert!(planned[0]["tick"].as_u64() > Some(0), "{}", planned[0]);
    bench.prove(&run);
}

#[test]
fn without_them_the_same_planners_are_waited_for() {
    for fault in ["fault=nap", "fault=plan_nap"] {
        let (bench, flown) = Flying::start(&[fault], &[]).end();
        assert_eq!(flown.json()["planner_faults"], 0, "{flown:?}");
        let events = journal(&bench.runs()[0]);
        assert!(of_kind(&events, "planner_late").is_empty());
        assert_eq!(of_kind(&events, "planned")[0]["tick"], 0);
        bench.prove(&bench.runs()[0]);
    }
}

/// A console that holds a mission.
fn held() -> (Bench, Console) {
    let bench = Bench::new();
    let file = scenario("goto-single-obstacle.toml");
    let mut console = Console::open(bench.command(), &[file.to_str().unwrap()]);
    console.hear("Enter `start` to start");
    console.order("start\nyes\n");
    console.hear("Mission running");
    console.order("hold\n");
    console.hear("HELD");
    (bench, console)
}

#[test]
fn a_planner_that_is_killed_during_a_hold_is_reported_during_the_hold() {
    let (bench, mut console) = held();
    let workers = workers_of(console.pid());
    assert_eq!(workers.len(), 1, "{workers:?}");
    signal_it(workers[0], Signal::KILL);
    console.hear("was killed by SIGKILL");
    console.order("resume\nyes\n");
    console.hear("resumed");
    console.order("hold\n");
    console.hear("HELD");
    console.order("end\nyes\n");
    console.hear("Screen 7: Result.");
    assert_eq!(console.leave(), Some(1), "the operator ended the mission");
    let run = bench.runs().remove(0);
    let events = journal(&run);
    let failed = first_of(&events, "planner_failed").expect("the fault");
    assert!(failed < first_of(&events, "resumed").expect("the resumption"), "noticed during the hold");
    bench.prove(&run);
}

#[test]
fn a_planner_that_is_killed_before_the_start_is_reported_before_the_start() {
    let bench = Bench::new();
    let file = scenario("goto-single-obstacle.toml");
    let console = Console::open(bench.command(), &[file.to_str().unwrap()]);
    console.hear("Enter `start` to start");
    signal_it(workers_of(console.pid())[0], Signal::KILL);
    console.hear("was killed by SIGKILL");
    assert_eq!(console.leave(), Some(0));
    assert!(bench.runs().is_empty(), "nothing was started");
}

#[test]
fn a_planner_in_shadow_that_is_killed_during_a_hold_ends_during_the_hold() {
    let (bench, mut console) = held();
    let driving = workers_of(console.pid());
    console.order("shadow apf-dwa\n");
    console.hear("runs in shadow");
    let shadow = workers_of(console.pid()).into_iter().find(|worker| !driving.contains(worker));
    signal_it(shadow.expect("its worker"), Signal::KILL);
    console.hear("no longer runs in shadow");
    console.order("end\nyes\n");
    console.hear("Screen 7: Result.");
    console.leave();
    let run = bench.runs().remove(0);
    assert!(first_of(&journal(&run), "shadow_ended").is_some());
    bench.prove(&run);
}
