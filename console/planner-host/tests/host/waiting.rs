//! When the host waits, and what ends the wait.

use crate::desk::{Desk, LONG, ONE, opening, plan, soon};
use crate::stand::{built, config, words};
use mission::What;
use planner_host::HostConfig;
use std::time::{Duration, Instant};

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
    assert_eq!(desk.host.next(None), None, "without the wake-up it is the fault of a plan that hangs");
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
    let looks = std::iter::repeat_with(|| desk.host.next(Some(past)));
    let answer = looks.take_while(|_| past.elapsed() < LONG).flatten().next();
    assert_eq!(answer.unwrap().ask, id);
}

#[test]
fn a_planner_is_opened_between_two_ticks_and_its_answer_waits_for_the_next() {
    let mut desk = Desk::new(&built(), config());
    let id = desk.submit(ONE, opening("faulty", &words(&[("fault", "none")]), None));
    while desk.host.is_asked() {
        desk.host.attend(soon());
    }
    let answer = desk.host.next(Some(Instant::now())).unwrap();
    assert_eq!((answer.ask, answer.result.is_ok()), (id, true));
}
