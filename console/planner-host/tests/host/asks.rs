//! Several workers at once, asked and answered in any order.

use crate::desk::{Desk, ONE, TWO, opening, plan, step};
use crate::stand::{built, config, folder_with, impatient};
use crate::state::COUNTER;
use mission::planner::Parameters;
use mission::{Cause, Given, What};
use planner_host::HostConfig;
use std::time::Duration;

#[test]
fn two_workers_answer_independently() {
    let mut desk = Desk::new(&built(), HostConfig { plan_deadline: Duration::from_hours(1), ..config() });
    desk.open(ONE, "plan_hang");
    desk.open(TWO, "none");
    desk.submit(ONE, plan());
    for tick in 0..20 {
        assert!(matches!(desk.ask(TWO, step(tick)), Ok(Given::Command(_))));
    }
    assert!(matches!(desk.ask(TWO, plan()), Ok(Given::Plan(plan)) if plan.complete));
    let fault = desk.ask(ONE, step(0)).unwrap_err();
    assert!(fault.message.ends_with("it has not answered the previous request"), "{fault}");
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
fn a_worker_with_an_open_ask_takes_no_other() {
    let mut desk = Desk::new(&built(), config());
    desk.open(ONE, "none");
    let (first, second) = (desk.submit(ONE, plan()), desk.submit(ONE, step(0)));
    let (refused, planned) = (desk.next(), desk.next());
    assert_eq!((refused.ask, planned.ask), (second, first));
    let fault = refused.result.unwrap_err();
    assert_eq!(fault.cause, Cause::Refused);
    let sentence = "planner faulty is not available for step 0: it has not answered the previous request";
    assert_eq!(fault.message, sentence);
    assert!(planned.result.is_ok());
}

#[test]
fn a_worker_that_is_not_there_answers_that_it_is_gone() {
    let mut desk = Desk::new(&built(), config());
    desk.submit(ONE, What::Close);
    let fault = desk.ask(ONE, step(3)).unwrap_err();
    let sentence = "the planner is not available for step 3: its process has ended; choose the planner again";
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

/// A planner whose process ends soon after its first step.
fn dies_between_asks() -> String {
    let late = "if (++c->in_this_process >= 30) abort();";
    let leaves_thread =
        "pthread_t thread; if (!c->in_this_process++) pthread_create(&thread, NULL, soon, NULL);";
    let head = "#define _DEFAULT_SOURCE\n#include <pthread.h>\n#include <signal.h>\n#include <unistd.h>\n\
                static void *soon(void *p) { usleep(1000); kill(getpid(), SIGALRM); return p; }";
    format!("{head}\n{}", COUNTER.replace(late, leaves_thread))
}

#[test]
fn a_worker_that_died_between_asks_is_noticed_before_the_next_ask() {
    let (_folder, dirs) = folder_with("counter", &dies_between_asks());
    let mut desk = Desk::new(&dirs, config());
    desk.ask(ONE, opening("counter", &Parameters::new(), None)).unwrap();
    assert!(!desk.host.has_ended_idle(ONE));
    desk.ask(ONE, step(0)).unwrap();
    while !desk.host.has_ended_idle(ONE) {
        std::thread::yield_now();
    }
    let fault = desk.ask(ONE, What::Snapshot).unwrap_err();
    let how = "was killed by SIGALRM (an alarm that it had set) during a pause between two requests";
    assert_eq!((fault.cause, fault.message), (Cause::Died, format!("planner counter {how}")));
    assert!(!desk.host.has_ended_idle(ONE), "once");
}

#[test]
fn a_worker_that_died_between_asks_is_reported_at_the_next_ask() {
    let (_folder, dirs) = folder_with("counter", &dies_between_asks());
    let mut desk = Desk::new(&dirs, config());
    desk.ask(ONE, opening("counter", &Parameters::new(), None)).unwrap();
    desk.ask(ONE, step(0)).unwrap();
    std::thread::sleep(Duration::from_millis(200));
    assert_eq!(desk.host.next(None), None);
    let fault = desk.ask(ONE, step(1)).unwrap_err();
    assert_eq!(
        (fault.cause, fault.message.as_str()),
        (Cause::Died, "planner counter was killed by SIGALRM (an alarm that it had set) during step 1")
    );
}
