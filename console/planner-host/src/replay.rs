//! Asks a plugin once more what it was asked before it failed, alone in a worker.

use crate::supervisor::{Failure, Worker, WorkerCommand, wait_for_one};
use crate::survey::{load_of, refusal_text};
use crate::wire::answer::said_of;
use crate::wire::frame::{Incoming, Received};
use crate::wire::kind;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// How a replay ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Replayed {
    /// Every request was answered.
    ToTheEnd,
    /// It failed again; how, as a sentence.
    Failed(String),
}

/// Puts recorded requests to a worker, one after the other, and says what comes of each. With `patient` no deadline ends
/// it, for a debugger.
///
/// # Errors
/// The requests cannot be read, or no worker can be started.
pub fn replay(
    frames: &[u8],
    worker: &WorkerCommand,
    patient: bool,
    say: &mut dyn FnMut(&str),
) -> Result<Replayed, String> {
    let mut worker = Worker::spawn(worker).map_err(|failure| refusal_text(&failure))?;
    let (mut stream, mut incoming) = (frames, Incoming::default());
    for n in 1.. {
        match incoming.receive(&mut stream) {
            Received::Frame => {}
            Received::Closed => break,
            Received::Broken => return Err(format!("request {n} is damaged")),
        }
        let budget = incoming.soft_deadline().filter(|_| !patient).unwrap_or(Duration::from_hours(24));
        let budget = budget.mul_f64(10.0 / 9.0);
        let asked = worker.ask(incoming.kind(), budget, |w| {
            w.written(incoming.body().0);
        });
        let answer = asked.and_then(|()| answered(&mut worker, incoming.kind()));
        let what = name(&incoming);
        match answer {
            Ok(given) => say(&format!("{n:>4}  {what:<11} {given}")),
            Err(Failure::Planner(refusal)) if worker.is_idle() => {
                say(&format!("{n:>4}  {what:<11} gave up: {}", refusal.message));
            }
            Err(failure) => {
                let how = match failure {
                    // Only gdb knows how.
                    Failure::Died { .. } if patient => "its process ended in the debugger".to_owned(),
                    failure => sentence(&failure, budget),
                };
                say(&format!("{n:>4}  {what:<11} {how}"));
                return Ok(Replayed::Failed(format!("request {n} ({what}): {how}")));
            }
        }
    }
    Ok(Replayed::ToTheEnd)
}

/// The plugin's file that is named in recorded requests.
pub fn plugin_of(frames: &[u8]) -> Option<PathBuf> {
    let (mut stream, mut incoming) = (frames, Incoming::default());
    while incoming.receive(&mut stream) == Received::Frame {
        if incoming.kind() == kind::LOAD {
            return load_of(&mut incoming.body()).ok().flatten().map(|load| load.path.to_owned());
        }
    }
    None
}

/// What was asked, a step with the number of its tick.
fn name(request: &Incoming) -> String {
    let what = match request.kind() {
        kind::LOAD => "load",
        kind::CONFIGURE => "configure",
        kind::RECONFIGURE => "reconfigure",
        kind::RESTORE => "restore",
        kind::PLAN => "plan",
        kind::STEP => {
            let mut body = request.body();
            let sensed = body.flag().and_then(|_| body.sensed());
            return sensed.map_or_else(|_| "step".to_owned(), |sensed| format!("step {}", sensed.tick));
        }
        _ => "?",
    };
    what.to_owned()
}

/// Waits for the answer, in a few words.
fn answered(worker: &mut Worker, kind: u8) -> Result<String, Failure> {
    let outcome = loop {
        let ready = wait_for_one(worker, None);
        if let Some(outcome) = worker.advance(ready, Instant::now(), &mut |_| {}) {
            break outcome;
        }
    };
    outcome?;
    match kind {
        kind::LOAD => worker.take_planners().map(|(sealed, _)| format!("sha256 {}", sealed.sha256)),
        kind::PLAN => worker.take_answer(|body| {
            let plan = body.plan()?;
            said_of(body)?;
            Ok(format!("{} points, complete: {}", plan.path.len(), plan.complete))
        }),
        kind::STEP => worker.take_answer(|body| {
            let command = body.command()?;
            said_of(body)?;
            Ok(format!("{:?} {:?}", command.status, command.drive))
        }),
        kind::RESTORE => worker.take_answer(|_| Ok("done".to_owned())),
        _ => worker.take_answer(|body| said_of(body).map(|_| "done".to_owned())),
    }
}

fn sentence(failure: &Failure, budget: Duration) -> String {
    match failure {
        Failure::Hung | Failure::Late | Failure::Starved => {
            format!("did not answer within {:.1} s; its process was stopped", budget.as_secs_f64())
        }
        Failure::Planner(refusal) => refusal.message.clone(),
        other => refusal_text(other).replace(" while it was loaded", ""),
    }
}
