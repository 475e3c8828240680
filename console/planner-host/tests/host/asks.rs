//! Several workers at once, asked and answered in any order, and nothing blocks unless requested.

use crate::stand::{GOAL, built, config, folder_with, impatient, pose, sensed, with_site, words, worker};
use crate::state::COUNTER;
use mission::ask::{PlanAsk, Site, StepAsk, TaskLeft};
use mission::planner::Parameters;
use mission::{Answer, Ask, AskId, Cause, Fault, Given, PlannerChoice, What, WorkerId};
use nalgebra::Point2;
use planner_api::{Drive, Reason};
use planner_host::{Host, HostConfig, PluginDirs, WorkerCommand};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

const ONE: WorkerId = WorkerId(1);
const TWO: WorkerId = WorkerId(2);
/// Far longer than anything here takes.
const LONG: Duration = Duration::from_secs(30);

/// A host, and the mission's count of asks.
struct Desk {
    host: Host,
    n: u32,
}

impl Desk {
    fn new(dirs: &PluginDirs, config: HostConfig) -> Self {
        Self { host: Host::new(dirs, config), n: 0 }
    }

    fn submit(&mut self, worker: WorkerId, what: What) -> AskId {
        self.n += 1;
        let id = AskId { worker, n: self.n };
        self.host.submit(Ask { id, what });
        id
    }

    fn next(&mut self) -> Answer {
        self.host.next(None).expect("an answer")
    }

    /// Asks, and waits for the answer, which is the next one.
    fn ask(&mut self, worker: WorkerId, what: What) -> Result<Given, Fault> {
        let id = self.submit(worker, what);
        let answer = self.next();
        assert_eq!(answer.ask, id);
        answer.result
    }

    fn open(&mut self, worker: WorkerId, fault: &str) {
        let opened = self.ask(worker, opening("faulty", &words(&[("fault", fault)]), None));
        assert!(matches!(opened, Ok(Given::Opened(info)) if info.id == "faulty"));
    }

    fn count(&mut self, worker: WorkerId, tick: u64) -> u32 {
        match self.ask(worker, step(tick)).unwrap() {
            Given::Command(command) => match command.drive {
                Drive::Twist { v_m_per_s, .. } => (v_m_per_s * 1000.0).round() as u32,
                Drive::Velocity(_) => panic!("it drives by twists"),
            },
            other => panic!("{other:?}"),
        }
    }
}

fn site() -> Arc<Site> {
    Arc::new(with_site(|site| Site {
        revision: site.revision,
        boundary: world::Boundary::Circle { radius_m: 10.0 },
        obstacles: Vec::new(),
        zones: Vec::new(),
        limits: site.limits,
        swath_m: site.swath_m,
        clearance_m: site.clearance_m,
        seed: site.seed,
    }))
}

fn opening(planner: &str, parameters: &Parameters, restore: Option<AskId>) -> What {
    let choice = PlannerChoice { id: planner.to_owned(), parameters: parameters.clone() };
    What::Open { choice, site: site(), restore }
}

fn plan() -> What {
    let task = TaskLeft::Goto { goal: GOAL, tolerance_m: 0.1 };
    let (reason, start) = (Reason::Start, pose(Point2::origin()));
    What::Plan(Box::new(PlanAsk { reason, start, task, site: site(), previous: Vec::new() }))
}

fn step(tick: u64) -> What {
    What::Step(Box::new(sensed(tick, |sensed| StepAsk {
        tick,
        t_s: sensed.t_s,
        dt_s: sensed.dt_s,
        pose: sensed.pose,
        v_m_per_s: 0.0,
        w_rad_per_s: 0.0,
        target: sensed.target,
        targets_ahead: vec![sensed.target],
        path_ahead: Vec::new(),
        obstacles: Vec::new(),
    })))
}

fn soon() -> Instant {
    Instant::now() + Duration::from_millis(20)
}

#[test]
fn two_workers_answer_independently() {
    let mut desk = Desk::new(&built(), config());
    desk.open(ONE, "plan_hang");
    desk.open(TWO, "none");
    let hangs = desk.submit(ONE, plan());
    for tick in 0..20 {
        assert!(matches!(desk.ask(TWO, step(tick)), Ok(Given::Command(_))));
    }
    assert!(matches!(desk.ask(TWO, plan()), Ok(Given::Plan(plan)) if plan.complete));
    assert!(desk.host.next(Some(soon())).is_none_or(|answer| answer.ask == hangs));
}

#[test]
fn workers_are_opened_at_the_same_time() {
    let mut desk = Desk::new(&built(), config());
    let ids = [ONE, TWO].map(|worker| desk.submit(worker, opening("faulty", &Parameters::new(), None)));
    let mut answers = [desk.next(), desk.next()];
    answers.sort_by_key(|answer| answer.ask);
    assert_eq!(answers.each_ref().map(|answer| answer.ask), ids);
    assert!(answers.iter().all(|answer| matches!(answer.result, Ok(Given::Opened(_)))));
}

#[test]
fn a_crash_in_one_worker_does_not_disturb_the_other() {
    let mut desk = Desk::new(&built(), config());
    desk.open(ONE, "segv");
    desk.open(TWO, "none");
    (0..5).for_each(|tick| drop(desk.ask(ONE, step(tick)).unwrap()));
    let (dies, plans) = (desk.submit(ONE, step(5)), desk.submit(TWO, plan()));
    let mut answers = [desk.next(), desk.next()];
    answers.sort_by_key(|answer| answer.ask);
    let [died, planned] = answers;
    assert_eq!((died.ask, planned.ask), (dies, plans));
    let fault = died.result.unwrap_err();
    assert_eq!(fault.cause, Cause::Died, "{fault}");
    assert!(fault.message.contains("SIGSEGV") && fault.plugin_sha256.is_some(), "{fault}");
    assert!(matches!(planned.result, Ok(Given::Plan(_))));
    assert!(desk.ask(TWO, step(0)).is_ok());
    assert_eq!(desk.ask(ONE, step(6)).unwrap_err().cause, Cause::Died, "its process has ended");
}

#[test]
fn a_waker_interrupts_the_wait_for_a_plan_that_hangs() {
    let mut desk = Desk::new(&built(), HostConfig { plan_deadline: LONG, ..config() });
    desk.open(ONE, "plan_hang");
    desk.submit(ONE, plan());
    let waker = desk.host.waker();
    let waking = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(50));
        waker.wake();
    });
    let asked = Instant::now();
    assert_eq!(desk.host.next(None), None);
    assert!(asked.elapsed() < LONG / 2);
    waking.join().unwrap();
    desk.submit(ONE, What::Close);
    assert_eq!(desk.host.next(None), None, "a closed worker answers nothing");
}

#[test]
fn earlier_wake_ups_count_once() {
    let mut desk = Desk::new(&built(), config());
    desk.open(ONE, "none");
    let waker = desk.host.waker();
    waker.wake();
    waker.clone().wake();
    let id = desk.submit(ONE, plan());
    assert_eq!(desk.host.next(None), None);
    assert_eq!(desk.next().ask, id, "the answer is not lost");
    waker.wake();
    desk.host.clear_wake_ups();
    assert!(desk.ask(ONE, plan()).is_ok());
}

#[test]
fn without_an_open_ask_nobody_waits() {
    let mut desk = Desk::new(&built(), config());
    assert_eq!(desk.host.next(None), None);
    desk.open(ONE, "none");
    assert_eq!(desk.host.next(None), None);
}

#[test]
fn what_has_arrived_is_seen_also_when_time_is_up() {
    let mut desk = Desk::new(&built(), config());
    desk.open(ONE, "none");
    let id = desk.submit(ONE, plan());
    let past = Instant::now();
    let answer = std::iter::repeat_with(|| desk.host.next(Some(past))).take(1_000_000).flatten().next();
    assert_eq!(answer.unwrap().ask, id);
}

#[test]
fn a_worker_with_an_open_ask_takes_no_other() {
    let mut desk = Desk::new(&built(), config());
    desk.open(ONE, "none");
    let (first, second) = (desk.submit(ONE, plan()), desk.submit(ONE, step(0)));
    let (refused, planned) = (desk.next(), desk.next());
    assert_eq!((refused.ask, planned.ask), (second, first));
    let fault = refused.result.unwrap_err();
    assert_eq!(fault.cause, Cause::Refused);
    let sentence = "planner faulty cannot do step 0: it has not answered what it was asked before";
    assert_eq!(fault.message, sentence);
    assert!(planned.result.is_ok());
}

#[test]
fn a_worker_that_is_not_there_answers_that_it_is_gone() {
    let mut desk = Desk::new(&built(), config());
    desk.submit(ONE, What::Close);
    let fault = desk.ask(ONE, step(3)).unwrap_err();
    let sentence = "the planner cannot do step 3: its process has ended and it must be chosen again";
    assert_eq!((fault.cause, fault.message.as_str()), (Cause::Died, sentence));
    desk.open(ONE, "none");
    desk.submit(ONE, What::Close);
    assert_eq!(desk.ask(ONE, What::Snapshot).unwrap_err().cause, Cause::Died);
}

#[test]
fn stopped_and_computing_workers_hang_in_their_own_time() {
    let mut desk = Desk::new(&built(), impatient());
    desk.open(ONE, "stop");
    desk.open(TWO, "hang");
    for tick in 0..5 {
        for worker in [ONE, TWO] {
            desk.ask(worker, step(tick)).unwrap();
        }
    }
    for worker in [ONE, TWO] {
        desk.submit(worker, step(5));
    }
    for fault in [desk.next(), desk.next()].map(|answer| answer.result.unwrap_err()) {
        assert_eq!(fault.cause, Cause::Hung, "{fault}");
    }
}

/// How many processes run this program.
fn running(program: &Path) -> usize {
    let processes = std::fs::read_dir("/proc").unwrap().flatten();
    processes.filter(|process| process.path().join("exe").read_link().is_ok_and(|exe| exe == program)).count()
}

/// A worker program of its own, so that its processes can be distinguished from those of other tests.
fn own_worker() -> (tempfile::TempDir, WorkerCommand) {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().canonicalize().unwrap().join("worker");
    std::fs::copy(worker().program, &program).unwrap();
    (folder, WorkerCommand::new(program))
}

#[cfg(target_os = "linux")]
#[test]
fn who_is_closed_or_failed_leaves_no_process_behind() {
    let (_folder, worker_command) = own_worker();
    let program = worker_command.program.clone();
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
            assert_eq!(running(&program), 1, "{fault}");
            (0..5).for_each(|tick| drop(desk.ask(ONE, step(tick)).unwrap()));
            desk.submit(ONE, what.clone());
            if !closes_at_once {
                assert_eq!(desk.next().result.is_ok(), fault == "none", "{fault}");
            }
            if closes_at_once || fault == "none" {
                desk.submit(ONE, What::Close);
            }
            let began = Instant::now();
            while running(&program) > 0 {
                assert_eq!(desk.host.next(Some(soon())), None);
                assert!(began.elapsed() < LONG, "{fault}: it still runs");
            }
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_closed_worker_ends_also_when_nobody_looks_at_it() {
    let (_folder, worker_command) = own_worker();
    let program = worker_command.program.clone();
    let mut desk = Desk::new(&built(), HostConfig { worker_command, ..config() });
    desk.open(ONE, "plan_hang");
    desk.submit(ONE, plan());
    desk.submit(ONE, What::Close);
    let began = Instant::now();
    // A process that has ended and is not reaped yet runs nothing.
    while running(&program) > 0 {
        assert!(began.elapsed() < LONG, "it still runs");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_host_that_is_dropped_takes_its_workers_along() {
    let (_folder, worker_command) = own_worker();
    let program = worker_command.program.clone();
    let mut desk = Desk::new(&built(), HostConfig { worker_command, ..config() });
    desk.open(ONE, "plan_hang");
    desk.open(TWO, "none");
    desk.submit(ONE, plan());
    drop(desk);
    assert_eq!(running(&program), 0);
}

fn counters() -> (tempfile::TempDir, Desk) {
    let (folder, dirs) = folder_with("counter", COUNTER);
    let desk = Desk::new(&dirs, config());
    (folder, desk)
}

#[test]
fn a_state_that_was_saved_under_an_ask_is_restored_in_another_worker() {
    let (_folder, mut desk) = counters();
    let open = |restore| opening("counter", &Parameters::new(), restore);
    desk.ask(ONE, open(None)).unwrap();
    assert_eq!((0..3).map(|tick| desk.count(ONE, tick)).last(), Some(3));
    assert_eq!(desk.ask(ONE, What::Snapshot), Ok(Given::State { bytes: 4 }));
    let saved = AskId { worker: ONE, n: desk.n };
    assert_eq!(desk.count(ONE, 3), 4);
    desk.submit(ONE, What::Close);
    desk.ask(TWO, open(Some(saved))).unwrap();
    assert_eq!(desk.count(TWO, 4), 4, "the state outlives its worker");
    let unknown = AskId { worker: ONE, n: 1 };
    desk.ask(ONE, open(Some(unknown))).unwrap();
    assert_eq!(desk.count(ONE, 0), 1, "without a state it starts fresh");
}

#[test]
fn a_planner_without_a_state_gives_none() {
    let mut desk = Desk::new(&built(), config());
    desk.open(ONE, "none");
    assert_eq!(desk.ask(ONE, What::Snapshot), Ok(Given::State { bytes: 0 }));
    let refuses = "{ (void)p; (void)h; return TP_E_STATE; }";
    let gives = "{\n  h->bytes(h->ctx, p, sizeof(uint32_t));\n  return TP_OK;\n}";
    let (_folder, dirs) = folder_with("counter", &COUNTER.replace(gives, refuses));
    let mut desk = Desk::new(&dirs, config());
    desk.ask(ONE, opening("counter", &Parameters::new(), None)).unwrap();
    assert_eq!(desk.ask(ONE, What::Snapshot), Ok(Given::State { bytes: 0 }));
    assert_eq!((desk.count(ONE, 0), desk.host.stats().faults), (1, 0));
}

#[test]
fn a_worker_that_died_between_asks_is_reported_at_the_next_ask() {
    let late = "if (++c->in_this_process >= 30) abort();";
    let at_exit = "if (!c->in_this_process++) signal(SIGALRM, SIG_DFL), ualarm(1000, 0);";
    let source = COUNTER
        .replace(late, at_exit)
        .replace("#include <stdlib.h>", "#include <signal.h>\n#include <stdlib.h>\n#include <unistd.h>");
    let source = format!("#define _DEFAULT_SOURCE\n{source}");
    let (_folder, dirs) = folder_with("counter", &source);
    let mut desk = Desk::new(&dirs, config());
    desk.ask(ONE, opening("counter", &Parameters::new(), None)).unwrap();
    desk.ask(ONE, step(0)).unwrap();
    std::thread::sleep(Duration::from_millis(200));
    assert_eq!(desk.host.next(None), None);
    let fault = desk.ask(ONE, step(1)).unwrap_err();
    assert_eq!(
        (fault.cause, fault.message.as_str()),
        (Cause::Died, "planner counter was killed by signal 14 during step 1")
    );
}
