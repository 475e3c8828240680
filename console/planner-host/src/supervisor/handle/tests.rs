//! The supervisor against workers that say what they like: a shell that writes bytes into its socket.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::Progress;
use std::sync::Mutex;

/// Long enough for a busy machine to start a shell.
const PATIENT: Duration = Duration::from_secs(10);

/// A worker that runs this script; its standard input is the socket.
fn worker(script: &str) -> Worker {
    let command = WorkerCommand { program: "/bin/sh".into(), arguments: vec!["-c".into(), script.into()] };
    Worker::spawn(&command).unwrap()
}

/// A worker that says this at once and then only listens.
fn saying(frames: &[Vec<u8>]) -> Worker {
    worker(&format!("printf '{}' >&0; while read -r line; do :; done", octal(&frames.concat())))
}

fn octal(bytes: &[u8]) -> String {
    let escapes: Vec<String> = bytes.iter().map(|byte| format!("\\{byte:03o}")).collect();
    escapes.concat()
}

fn frame(kind: u8, sequence: u32, write: impl FnOnce(&mut Writer)) -> Vec<u8> {
    let mut writer = Writer::default();
    write(writer.begin(kind, sequence, 0));
    writer.finish().unwrap().to_vec()
}

fn progress(sequence: u32, share: f64, what: &str) -> Vec<u8> {
    let progress = Progress { share, what: what.to_owned() };
    frame(kind::PROGRESS, sequence, |w| {
        w.progress(&progress);
    })
}

fn done(sequence: u32) -> Vec<u8> {
    frame(kind::DONE, sequence, |w| {
        w.u32(7);
    })
}

fn ask(worker: &mut Worker, kind: u8, deadline: Duration) -> Result<u32, Failure> {
    worker.ask(kind, deadline, |_| {}, number)
}

fn number(body: &mut Body<'_>) -> Read<u32> {
    body.u32()
}

#[test]
fn progress_before_the_answer_to_a_plan_is_passed_on() {
    let mut worker = saying(&[progress(1, 0.25, "one of two"), progress(1, 1.0, ""), done(1), done(2)]);
    let heard = Arc::new(Mutex::new(Vec::new()));
    let hearing = Arc::clone(&heard);
    worker.tell_progress(Arc::new(move |progress| hearing.lock().unwrap().push(progress.clone())));
    assert_eq!(ask(&mut worker, kind::PLAN, PATIENT), Ok(7));
    let told = |share, what: &str| Progress { share, what: what.to_owned() };
    assert_eq!(*heard.lock().unwrap(), [told(0.25, "one of two"), told(1.0, "")]);
    assert_eq!(ask(&mut worker, kind::STEP, PATIENT), Ok(7), "the next answer is found");
}

#[test]
fn progress_that_nobody_asked_for_is_no_answer() {
    let long = "x".repeat(Progress::LONGEST + 1);
    let trailing = frame(kind::PROGRESS, 1, |w| {
        w.f64(0.5).text("a").u8(0);
    });
    for (kind, frame) in [
        (kind::STEP, progress(1, 0.5, "")),
        (kind::CONFIGURE, progress(1, 0.5, "")),
        (kind::PLAN, progress(2, 0.5, "")),
        (kind::PLAN, progress(0, 0.5, "")),
        (kind::PLAN, progress(1, 1.5, "")),
        (kind::PLAN, progress(1, f64::NAN, "")),
        (kind::PLAN, progress(1, 0.5, "\u{1b}[2J")),
        (kind::PLAN, progress(1, 0.5, &long)),
        (kind::PLAN, trailing),
    ] {
        let mut worker = saying(&[frame.clone(), done(1)]);
        assert_eq!(ask(&mut worker, kind, PATIENT), Err(Failure::Protocol), "{kind}: {frame:?}");
        assert!(worker.is_gone(), "its process was killed");
    }
}

#[test]
fn a_worker_that_tells_progress_without_end_is_killed_at_its_deadline_all_the_same() {
    let flood = octal(&progress(1, 0.5, "at it").repeat(50));
    let mut worker = worker(&format!("while printf '{flood}' >&0; do :; done"));
    let heard = Arc::new(Mutex::new(0));
    let hearing = Arc::clone(&heard);
    worker.tell_progress(Arc::new(move |_| *hearing.lock().unwrap() += 1));
    assert_eq!(ask(&mut worker, kind::PLAN, Duration::from_secs(1)), Err(Failure::Hung));
    let heard = *heard.lock().unwrap();
    assert!((1..100).contains(&heard), "{heard} of a flood were passed on");
}

#[test]
fn a_plan_that_is_wanted_no_more_is_given_up_amid_progress() {
    let flood = octal(&progress(1, 0.5, "at it").repeat(50));
    let mut worker = worker(&format!("while printf '{flood}' >&0; do :; done"));
    let stop = Arc::new(AtomicBool::new(false));
    worker.stop_on(Arc::clone(&stop));
    worker.tell_progress(Arc::new(move |_| stop.store(true, Ordering::Relaxed)));
    assert_eq!(ask(&mut worker, kind::PLAN, Duration::from_hours(1)), Err(Failure::Stopped));
}
