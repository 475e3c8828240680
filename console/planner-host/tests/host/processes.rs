//! No process of a worker is left behind, neither a running one nor a zombie.
#![cfg(target_os = "linux")]

use crate::desk::{Desk, LONG, ONE, TWO, opening, plan, soon, step};
use crate::stand::{built, config, folder_with, impatient, worker};
use crate::state::COUNTER;
use mission::planner::Parameters;
use mission::{Ask, AskId, Given, What};
use planner_host::{HostConfig, WorkerCommand};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// The maximum time for which a dropped host waits for the end of a worker that it has killed.
const REAPED_WITHIN: Duration = Duration::from_millis(30);

/// A worker program with a name of its own, so that its processes can be distinguished from those of other tests.
fn own_worker() -> (TempDir, WorkerCommand, String) {
    static N_WORKERS: AtomicU32 = AtomicU32::new(0);
    let name = format!("worker-{}", N_WORKERS.fetch_add(1, Ordering::Relaxed));
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join(&name);
    std::fs::copy(worker().program, &program).unwrap();
    (folder, WorkerCommand::new(program), name)
}

/// States of the processes with this name that this process has started but not reaped.
fn states(name: &str) -> Vec<char> {
    children(name).into_iter().map(|(_, state)| state).collect()
}

/// The ids of these processes.
fn pids(name: &str) -> Vec<String> {
    children(name).into_iter().map(|(pid, _)| pid).collect()
}

fn children(name: &str) -> Vec<(String, char)> {
    let processes = std::fs::read_dir("/proc").unwrap().flatten();
    let stats = processes.filter_map(|process| std::fs::read_to_string(process.path().join("stat")).ok());
    let child = |stat: String| Some((stat.split_once(' ')?.0.to_owned(), state_of_child(&stat, name)?));
    stats.filter_map(child).collect()
}

fn state_of_child(stat: &str, name: &str) -> Option<char> {
    let (_, stat) = stat.split_once('(')?;
    let (program, fields) = stat.rsplit_once(')')?;
    let mut fields = fields.split_ascii_whitespace();
    let (state, parent) = (fields.next()?.chars().next()?, fields.next()?);
    (program == name && parent == std::process::id().to_string()).then_some(state)
}

#[test]
fn who_is_closed_or_failed_leaves_no_process_behind() {
    let (_folder, worker_command, name) = own_worker();
    let mut desk = Desk::new(&built(), HostConfig { worker_command, ..impatient() });
    for (fault, what) in [
        ("none", step(5)),
        ("plan_hang", plan()),
        ("hang", step(5)),
        ("slow", step(5)),
        ("stop", step(5)),
        ("panic", step(5)),
    ] {
        for closes_at_once in [true, false] {
            desk.open(ONE, fault);
            assert_eq!(states(&name).len(), 1, "{fault}");
            (0..5).for_each(|tick| drop(desk.ask(ONE, step(tick)).unwrap()));
            desk.submit(ONE, what.clone());
            if !closes_at_once {
                assert_eq!(desk.next().result.is_ok(), fault == "none", "{fault}");
            }
            if closes_at_once || fault == "none" {
                desk.submit(ONE, What::Close);
            }
            let began = Instant::now();
            while !states(&name).is_empty() {
                assert_eq!(desk.host.next(Some(soon())), None);
                assert!(began.elapsed() < LONG, "{fault}: it is still there");
            }
        }
    }
}

#[test]
fn a_closed_worker_ends_also_when_nobody_looks_at_it() {
    let (_folder, worker_command, name) = own_worker();
    let mut desk = Desk::new(&built(), HostConfig { worker_command, ..config() });
    desk.open(ONE, "plan_hang");
    desk.submit(ONE, plan());
    desk.submit(ONE, What::Close);
    let began = Instant::now();
    // It has ended but has not been reaped.
    while states(&name) != ['Z'] {
        assert!(began.elapsed() < LONG, "it still runs: {:?}", states(&name));
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_host_that_is_dropped_takes_its_workers_along() {
    let (_folder, worker_command, name) = own_worker();
    let mut desk = Desk::new(&built(), HostConfig { worker_command, ..config() });
    desk.open(ONE, "plan_hang");
    desk.open(TWO, "none");
    desk.submit(ONE, plan());
    assert_eq!(states(&name).len(), 2);
    let began = Instant::now();
    drop(desk);
    let gave_up = began.elapsed() >= REAPED_WITHIN;
    assert!(states(&name).is_empty() || gave_up, "{:?}", states(&name));
}

#[test]
fn the_process_of_a_planner_serves_the_next_mission_from_the_beginning() {
    let (_counters, dirs) = folder_with("counter", COUNTER);
    let (_folder, worker_command, name) = own_worker();
    let mut desk = Desk::new(&dirs, HostConfig { worker_command, ..config() });
    let mut fly = |seen: &mut Vec<u32>| {
        let opened = desk.ask(ONE, opening("counter", &Parameters::new(), None));
        assert!(matches!(opened, Ok(Given::Opened(_))), "{opened:?}");
        // The counter aborts at its thirtieth step.
        (0..20).for_each(|tick| seen.push(desk.count(ONE, tick)));
        desk.host.end_mission();
        pids(&name)
    };
    let (mut first, mut second) = (Vec::new(), Vec::new());
    let process = fly(&mut first);
    assert_eq!(process.len(), 1);
    assert_eq!(fly(&mut second), process);
    assert_eq!(first, second);
}

#[test]
fn who_has_not_answered_when_a_mission_ends_serves_no_other_one() {
    let (_folder, worker_command, name) = own_worker();
    let mut desk = Desk::new(&built(), HostConfig { worker_command, ..config() });
    desk.open(ONE, "plan_hang");
    let before = pids(&name);
    desk.submit(ONE, plan());
    desk.host.end_mission();
    desk.open(ONE, "none");
    assert!(pids(&name).iter().any(|pid| !before.contains(pid)), "{before:?}");
    assert!(desk.ask(ONE, step(0)).is_ok());
}

#[test]
fn who_waits_for_every_command_shares_a_processor_with_the_planner_while_nothing_else_is_done() {
    let here = || rustix::thread::sched_getaffinity(None).unwrap();
    // Runs in a thread of its own, so that the processors on which the test's own thread may run stay as they are.
    let shared = || {
        let (_folder, worker_command, name) = own_worker();
        let mut desk = Desk::new(&built(), HostConfig { worker_command, ..config() });
        desk.host.share_processor();
        let there = || {
            let of = |pid: &String| std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap();
            let is_list = |line: &&str| line.starts_with("Cpus_allowed_list");
            let list = |pid| of(pid).lines().find(is_list).unwrap().to_owned();
            pids(&name).iter().map(list).collect::<Vec<_>>().concat()
        };
        desk.open(ONE, "none");
        let (all, apart) = (here(), there());
        desk.ask(ONE, step(5)).unwrap();
        assert!(all.count() == 1 || here().count() == 1 && !there().contains(['-', ',']), "{}", there());
        desk.ask(ONE, plan()).unwrap();
        assert!(here() == all && there() == apart, "a plan may use all processors");
        desk.ask(ONE, step(6)).unwrap();
        desk.open(TWO, "none");
        assert!(here() == all && there() == apart.repeat(2), "a new process, too");
        desk.host.submit(Ask { id: AskId { worker: TWO, n: 99 }, what: What::Close });
        desk.ask(ONE, step(7)).unwrap();
        drop(desk);
        assert!(here() == all);
    };
    std::thread::scope(|scope| scope.spawn(shared).join().unwrap());
}
