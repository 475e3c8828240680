//! Every kind of misbehaviour ends as a fault with one sentence, and another planner can take over.

use crate::desk::LONG;
use crate::stand::{assert_another_drives, choose, config, fly, host, impatient, plan, step, words};
use mission::planner::{During, ParamValue, Parameters};
use mission::{Cause, Fault};
use planner_api::{Code, LogLevel};
use planner_host::HostConfig;
use std::time::{Duration, Instant};

/// The fault of a planner that is configured to commit it at its sixth step.
fn fault_of(kind: &str, config: HostConfig) -> Fault {
    let mut host = host(config);
    let sha256 = choose(&mut host, "faulty", &words(&[("fault", kind)])).unwrap().sha256;
    let fault = fly(&mut host).unwrap_err();
    assert_eq!((fault.planner.as_str(), fault.during), ("faulty", During::Step));
    assert_eq!(fault.plugin_sha256.as_deref(), Some(sha256.as_str()));
    assert_another_drives(&mut host);
    fault
}

fn assert_dies(kind: &str, how: &str) {
    let fault = fault_of(kind, config());
    assert_eq!(fault.cause, Cause::Died, "{fault}");
    assert!(fault.message.starts_with(&format!("planner faulty {how}")), "{fault}");
    assert!(fault.message.contains("during step 5"), "{fault}");
}

#[test]
fn a_panic_names_file_line_step_and_text() {
    let fault = fault_of("panic", config());
    assert_eq!(fault.cause, Cause::Panic);
    let (before, after) = fault.message.split_once(".rs:").unwrap();
    assert_eq!(before, "planner faulty panicked at plugins/faulty/src/faults");
    let (_line, after) = after.split_once(' ').unwrap();
    assert_eq!(after, "during step 5: index out of bounds: the len is 0 but the index is 7");
}

#[test]
fn a_panic_without_text_is_a_panic() {
    let fault = fault_of("panic_payload", config());
    assert_eq!(fault.cause, Cause::Panic);
    assert!(fault.message.ends_with("the panic has no message"), "{fault}");
}

#[test]
fn a_panic_in_a_thread_of_the_planner_is_its_own_affair() {
    let fault = fault_of("thread_panic", config());
    assert_eq!(fault.cause, Cause::Planner(Code::Internal));
    assert_eq!(fault.message, "planner faulty gave up at step 5: a thread of the planner panicked");
}

#[test]
fn a_refusal_is_passed_on() {
    let fault = fault_of("error", config());
    assert_eq!(fault.cause, Cause::Planner(Code::Stuck));
    assert_eq!(fault.message, "planner faulty gave up at step 5: a local minimum, as ordered");
}

#[test]
fn a_refusal_does_not_end_the_process() {
    let mut host = host(config());
    choose(&mut host, "faulty", &words(&[("fault", "error")])).unwrap();
    fly(&mut host).unwrap_err();
    assert!(plan(&mut host).is_ok(), "the same instance answers");
}

#[test]
fn an_invalid_memory_access_is_reported() {
    assert_dies("segv", "was killed by SIGSEGV (invalid memory access)");
}

#[test]
fn an_abort_is_reported() {
    assert_dies("abort", "was killed by SIGABRT");
}

#[test]
fn a_planner_that_ends_its_process_is_reported() {
    assert_dies("exit", "ended its own process with exit code 0");
}

#[test]
fn a_planner_that_is_killed_is_reported() {
    assert_dies("kill", "was killed by SIGKILL");
}

#[test]
fn a_stack_overflow_is_reported_with_the_last_output() {
    let fault = fault_of("stack", config());
    assert_eq!(fault.cause, Cause::Died, "{fault}");
    assert!(fault.message.contains("stack overflow"), "{fault}");
}

#[test]
fn running_out_of_memory_is_reported_with_the_last_output() {
    let fault = fault_of("alloc", HostConfig { step_deadline: Duration::from_secs(10), ..config() });
    assert_eq!(fault.cause, Cause::Died, "{fault}");
    assert!(fault.message.ends_with("last output: memory allocation of 67108864 bytes failed"), "{fault}");
}

#[test]
fn a_planner_that_closes_everything_loses_only_itself() {
    assert_dies("close_fds", "lost its channel to the console");
}

#[test]
fn a_planner_that_does_not_answer_is_killed_in_time() {
    for kind in ["hang", "sleep", "stop"] {
        let mut host = host(impatient());
        choose(&mut host, "faulty", &words(&[("fault", kind)])).unwrap();
        (0..5).for_each(|tick| drop(step(&mut host, tick).unwrap()));
        let asked = Instant::now();
        let fault = step(&mut host, 5).unwrap_err();
        let took = asked.elapsed();
        assert_eq!(fault.cause, Cause::Hung, "{kind}");
        let sentence = "planner faulty did not finish step 5 in time and ignored the request to stop; its process was killed";
        assert_eq!(fault.message, sentence, "{kind}");
        assert!(took < LONG, "{kind} took {took:?}");
        assert_eq!(step(&mut host, 6).unwrap_err().cause, Cause::Died, "its process has ended");
        assert_another_drives(&mut host);
    }
}

#[test]
fn a_planner_that_stops_when_asked_is_late_and_its_process_ends() {
    let mut host = host(impatient());
    choose(&mut host, "faulty", &words(&[("fault", "slow")])).unwrap();
    let fault = fly(&mut host).unwrap_err();
    assert_eq!(fault.cause, Cause::Late);
    assert_eq!(fault.message, "planner faulty was too slow: it missed the deadline for step 5");
    let fault = plan(&mut host).unwrap_err();
    assert_eq!(fault.cause, Cause::Died);
    let sentence =
        "planner faulty is not available for plan: its process has ended; choose the planner again";
    assert_eq!(fault.message, sentence);
    assert_another_drives(&mut host);
}

#[test]
fn numbers_that_no_robot_can_follow_are_caught() {
    let fault = fault_of("nan", config());
    assert_eq!(fault.cause, Cause::BadOutput);
    assert_eq!(fault.message, "planner faulty gave a speed that is not a number during step 5");
    let fault = fault_of("huge", config());
    assert_eq!(fault.cause, Cause::BadOutput);
    assert!(fault.message.contains("speed of 1e308 m/s; the robot's limit is 0.3 m/s"), "{fault}");
}

#[test]
fn a_flood_of_drawings_is_truncated_and_reported() {
    let mut host = host(config());
    choose(&mut host, "faulty", &words(&[("fault", "draw_flood")])).unwrap();
    let flood = (0..6).map(|tick| step(&mut host, tick).unwrap()).last().unwrap();
    assert_eq!(flood.drawings.len(), 4096);
    let (level, message) = &flood.logs[0];
    assert_eq!(*level, LogLevel::Warn);
    assert!(message.starts_with("dropped drawings, figures or messages: 95904;"), "{message}");
}

#[test]
fn floods_of_text_and_panics_on_the_way_out_harm_nobody() {
    for kind in ["print_flood", "drop_panic", "none"] {
        let mut host = host(config());
        choose(&mut host, "faulty", &words(&[("fault", kind)])).unwrap();
        fly(&mut host).unwrap();
        assert_another_drives(&mut host);
    }
}

#[test]
fn a_planner_that_fails_while_it_is_made_leaves_the_one_before_in_place() {
    for (kind, cause, words_of_it) in [
        ("configure_panic", Cause::Panic, "during configure: "),
        ("configure_hang", Cause::Hung, "did not finish configure in time"),
    ] {
        let mut host = host(impatient());
        choose(&mut host, "faulty", &Parameters::new()).unwrap();
        let fault = choose(&mut host, "faulty", &words(&[("fault", kind)])).unwrap_err();
        assert_eq!((fault.during, fault.cause), (During::Configure, cause));
        assert!(fault.message.contains(words_of_it), "{fault}");
        fly(&mut host).unwrap();
    }
}

#[test]
fn a_planner_that_fails_while_it_plans_is_reported() {
    for (kind, cause) in [("plan_panic", Cause::Panic), ("plan_hang", Cause::Hung)] {
        let mut host = host(impatient());
        choose(&mut host, "faulty", &words(&[("fault", kind)])).unwrap();
        let fault = plan(&mut host).unwrap_err();
        assert_eq!((fault.during, fault.cause), (During::Plan, cause), "{fault}");
        assert_another_drives(&mut host);
    }
}

#[test]
fn the_same_fault_reads_the_same_every_time() {
    for kind in ["panic", "segv", "stack", "exit", "close_fds"] {
        assert_eq!(fault_of(kind, config()), fault_of(kind, config()));
    }
}

#[test]
fn calls_are_counted_and_timed() {
    let mut host = host(config());
    choose(&mut host, "faulty", &Parameters::new()).unwrap();
    plan(&mut host).unwrap();
    fly(&mut host).unwrap();
    let stats = host.stats();
    assert_eq!((stats.plan.calls, stats.step.calls, stats.faults), (1, 10, 0));
    assert!(stats.step.p50_us > Some(0.0) && stats.step.p50_us <= stats.step.p99_us);
}

#[test]
fn parameters_are_checked_before_a_planner_sees_them() {
    let mut host = host(config());
    let at_step = |value| Parameters::from([("at_step".to_owned(), value)]);
    let refused_during = |during, fault: Fault| {
        assert_eq!((fault.during, fault.cause), (during, Cause::Refused));
        fault.message
    };
    let refused = |fault| refused_during(During::Configure, fault);
    let message = refused(choose(&mut host, "faulty", &words(&[("falt", "none")])).unwrap_err());
    assert_eq!(message, "planner faulty has no parameter `falt`; did you mean `fault`?");
    let message = refused(choose(&mut host, "faulty", &at_step(ParamValue::Int(-1))).unwrap_err());
    assert_eq!(message, "parameter `at_step` of planner faulty takes 0 to 1000000, not -1");
    choose(&mut host, "faulty", &Parameters::new()).unwrap();
    let fault = host.reconfigure(&at_step(ParamValue::Int(3))).unwrap_err();
    let message = refused_during(During::Reconfigure, fault);
    assert_eq!(
        message,
        "parameter `at_step` of planner faulty cannot change during a mission; its old values stay in effect"
    );
    assert_eq!(host.stats().faults, 3);
}

#[test]
fn without_a_planner_there_is_a_sentence() {
    let fault = step(&mut host(config()), 0).unwrap_err();
    assert_eq!((fault.cause, fault.message.as_str()), (Cause::Refused, "no planner has been chosen"));
}

#[test]
fn a_host_may_move_to_another_thread() {
    let mut host = host(config());
    choose(&mut host, "faulty", &Parameters::new()).unwrap();
    std::thread::spawn(move || fly(&mut host)).join().unwrap().unwrap();
}
