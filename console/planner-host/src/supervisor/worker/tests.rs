//! Tests the supervisor against workers that send whatever they like: shells that write bytes to their sockets.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::supervisor::wait_for_one;
use crate::wire::body::whole;
use crate::wire::kind;

/// Long enough for a busy machine to start a shell.
const PATIENT: Duration = Duration::from_secs(10);

/// A worker that runs this script; its standard input is the socket.
fn worker(script: &str) -> Worker {
    let command = WorkerCommand { program: "/bin/sh".into(), arguments: vec!["-c".into(), script.into()] };
    Worker::spawn(&command, 256 << 20).unwrap()
}

/// A worker that answers each request without a body with the next of these answers, and then only listens.
fn answering(answers: &[&[Vec<u8>]]) -> Worker {
    let answer =
        |frames: &&[Vec<u8>]| format!("head -c 13 > /dev/null; printf '{}' >&0;", octal(&frames.concat()));
    let answers: Vec<String> = answers.iter().map(answer).collect();
    worker(&format!("{} while read -r line; do :; done", answers.concat()))
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
        w.put(&progress);
    })
}

fn done(sequence: u32) -> Vec<u8> {
    frame(kind::DONE, sequence, |w| {
        w.put(&7_u32);
    })
}

fn ask(
    worker: &mut Worker,
    kind: u8,
    budget: Duration,
    mut on_progress: impl FnMut(&Progress),
) -> Result<u32, Failure> {
    worker.ask(kind, budget, |_| {})?;
    answer(worker, &mut on_progress)
}

/// Waits for the answer.
fn answer(worker: &mut Worker, on_progress: &mut dyn FnMut(&Progress)) -> Result<u32, Failure> {
    loop {
        let ready = wait_for_one(worker, None);
        if let Some(outcome) = worker.advance(ready, Instant::now(), on_progress) {
            return outcome.and_then(|()| worker.take_answer(whole));
        }
    }
}

/// Polls a worker until it has ended.
fn see_to_its_end(worker: &mut Worker) {
    while !worker.is_gone() {
        let ready = wait_for_one(worker, None);
        assert_eq!(worker.advance(ready, Instant::now(), &mut |_| {}), None);
    }
}

#[test]
fn progress_before_the_answer_to_a_plan_is_passed_on() {
    let plan = [progress(1, 0.25, "one of two"), progress(1, 1.0, ""), done(1)];
    let mut worker = answering(&[&plan, &[done(2)]]);
    let mut received = Vec::new();
    let receive = |progress: &Progress| received.push(progress.clone());
    assert_eq!(ask(&mut worker, kind::PLAN, PATIENT, receive), Ok(7));
    let expected = |share, what: &str| Progress { share, what: what.to_owned() };
    assert_eq!(received, [expected(0.25, "one of two"), expected(1.0, "")]);
    assert_eq!(ask(&mut worker, kind::STEP, PATIENT, |_| {}), Ok(7), "the next answer is found");
}

#[test]
fn what_comes_after_an_answer_is_none() {
    let mut worker = answering(&[&[done(1), done(2)]]);
    assert_eq!(ask(&mut worker, kind::STEP, PATIENT, |_| {}), Ok(7));
    assert_eq!(ask(&mut worker, kind::STEP, PATIENT, |_| {}), Err(Failure::Protocol));
    see_to_its_end(&mut worker);
}

#[test]
fn progress_that_nobody_asked_for_is_no_answer() {
    let long = "x".repeat(Progress::LONGEST + 1);
    let trailing = frame(kind::PROGRESS, 1, |w| {
        w.put(&(0.5, "a", 0_u8));
    });
    for (kind, frame) in [
        (kind::STEP, progress(1, 0.5, "")),
        (kind::CONFIGURE, progress(1, 0.5, "")),
        (kind::PLAN, progress(2, 0.5, "")),
        (kind::PLAN, progress(0, 0.5, "")),
        (kind::PLAN, progress(1, 1.5, "")),
        (kind::PLAN, progress(1, f64::NAN, "")),
        (kind::PLAN, progress(1, 0.5, &long)),
        (kind::PLAN, trailing),
    ] {
        let mut worker = answering(&[&[frame.clone(), done(1)]]);
        assert_eq!(ask(&mut worker, kind, PATIENT, |_| {}), Err(Failure::Protocol), "{kind}: {frame:?}");
        see_to_its_end(&mut worker);
    }
}

#[test]
fn a_worker_that_reports_progress_endlessly_is_still_killed_at_its_deadline() {
    let flood = octal(&progress(1, 0.5, "at it").repeat(50));
    let mut worker = worker(&format!("while printf '{flood}' >&0; do :; done"));
    let (mut received, asked) = (0, Instant::now());
    assert_eq!(ask(&mut worker, kind::PLAN, Duration::from_secs(1), |_| received += 1), Err(Failure::Hung));
    let most = 21 + (40.0 * asked.elapsed().as_secs_f64()) as u32;
    assert!((1..=most).contains(&received), "{received} of a flood were passed on");
}

#[test]
fn a_worker_that_ignores_shutdown_while_reporting_progress_is_killed() {
    let flood = octal(&progress(1, 0.5, "at it").repeat(50));
    let mut worker = worker(&format!("while printf '{flood}' >&0; do :; done"));
    worker.ask(kind::PLAN, Duration::from_hours(1), |_| {}).unwrap();
    worker.shut_down();
    assert_eq!(worker.ask(kind::STEP, PATIENT, |_| {}), Err(Failure::Gone));
    see_to_its_end(&mut worker);
}

#[test]
fn a_request_that_does_not_fit_into_the_socket_is_written_piece_by_piece() {
    let length = 4 << 20;
    let folder = tempfile::tempdir().unwrap();
    let gate = folder.path().join("gate");
    let mut worker = worker(&format!(
        "while ! [ -e {} ]; do :; done; head -c {} > /dev/null; printf '{}' >&0; while read -r line; do :; done",
        gate.display(),
        length + 13,
        octal(&done(1))
    ));
    worker
        .ask(kind::PLAN, PATIENT, |w| {
            w.written(&vec![0; length]);
        })
        .unwrap();
    assert!(!worker.has_sent(), "nothing waits for room");
    std::fs::write(gate, "").unwrap();
    assert_eq!(answer(&mut worker, &mut |_| {}), Ok(7));
}

#[test]
fn a_worker_that_ends_has_died_even_if_a_child_of_it_keeps_its_socket() {
    let mut worker = worker("exec 3<&0; cat <&3 > /dev/null 2>&1 & exit 3");
    let how = "ended its own process with exit code 3".to_owned();
    let died = Failure::Died { how, last_output: String::new() };
    assert_eq!(ask(&mut worker, kind::STEP, PATIENT, |_| {}), Err(died));
}

#[test]
fn a_worker_that_prints_more_than_a_pipe_holds_before_it_answers_is_not_held_up() {
    let print = "head -c 1000000 /dev/zero";
    let answer = octal(&done(1));
    let mut worker = worker(&format!("head -c 13 > /dev/null; {print}; printf '{answer}' >&0; read -r line"));
    assert_eq!(ask(&mut worker, kind::STEP, PATIENT, |_| {}), Ok(7));
}

#[test]
fn a_worker_that_reads_nothing_is_killed_when_its_budget_is_used_up() {
    let mut worker = worker("while :; do sleep 1; done");
    worker
        .ask(kind::PLAN, Duration::from_millis(100), |w| {
            w.written(&vec![0; 4 << 20]);
        })
        .unwrap();
    assert_eq!(answer(&mut worker, &mut |_| {}), Err(Failure::Hung));
}
