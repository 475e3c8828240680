//! Repeats, in a separate worker, the requests that a plugin received before it failed, and checks the answers as the
//! console does.

mod judge;

use crate::discovery::sha256_hex;
use crate::remains::is_crash;
use crate::supervisor::{Failure, Worker, WorkerCommand};
use crate::survey::refusal_text;
use crate::wire::frame::{Incoming, Received};
use crate::wire::kind;
use crate::wire::request::Load;
use crate::worker::check_descriptors;
use judge::Judge;
use std::path::PathBuf;
use std::time::Duration;

/// The outcome of a replay.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Replayed {
    /// Every request was answered, and the console accepts every answer.
    ToTheEnd {
        /// The number of requests.
        requests: usize,
    },
    /// The plugin failed again; the text is a sentence that states how.
    Failed(String),
}

/// The reason why nothing was replayed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NotReplayed {
    /// The requests are incomplete; the text completes a sentence that begins with the name of their file.
    Damaged(String),
    /// This machine prevents planners from running.
    Machine(String),
}

/// Sends recorded requests to a worker, one at a time, and reports the outcome of each. If `patient`, sets no
/// deadlines, so that a debugger can be used.
///
/// # Errors
/// The requests are incomplete, or no worker can be started.
pub fn replay(
    frames: &[u8],
    worker: &WorkerCommand,
    patient: bool,
    say: &mut dyn FnMut(&str),
) -> Result<Replayed, NotReplayed> {
    check_descriptors().map_err(NotReplayed::Machine)?;
    let requests = whole(frames).map_err(NotReplayed::Damaged)?;
    // A debugger needs memory, too, so there is no limit.
    let limit = memory_limit_of(frames).filter(|_| !patient).unwrap_or(u64::MAX);
    let mut worker =
        Worker::spawn(worker, limit).map_err(|failure| NotReplayed::Machine(refusal_text(&failure)))?;
    let (mut stream, mut incoming, mut judge) = (frames, Incoming::default(), Judge::default());
    for n in 1..=requests {
        if incoming.receive(&mut stream) != Received::Frame {
            break;
        }
        judge.hear(&incoming).map_err(|_| NotReplayed::Damaged(format!("is damaged at request {n}")))?;
        let budget = incoming.soft_deadline().filter(|_| !patient).unwrap_or(Duration::from_hours(24));
        let budget = budget.mul_f64(10.0 / 9.0);
        let asked = worker.ask(incoming.kind(), budget, |w| {
            w.written(incoming.body().0);
        });
        let what = judge.name();
        match asked.and_then(|()| judge.answer(&mut worker)) {
            Ok(given) => say(&format!("{n:>4}  {what:<11} {given}")),
            // Only gdb can tell how the process ended.
            Err(_) if patient && !worker.is_idle() => {
                let how = "its process ended in the debugger";
                say(&format!("{n:>4}  {what:<11} {how}"));
                return Ok(Replayed::Failed(format!("request {n} ({what}): {how}")));
            }
            Err(Failure::Console(why)) => return Err(NotReplayed::Machine(format!("the plugin {why}"))),
            Err(failure) => {
                let fault = judge.fault(failure, budget);
                say(&format!("{n:>4}  {what:<11} {}", fault.message));
                if is_crash(fault.cause) || !worker.is_idle() || incoming.kind() == kind::LOAD {
                    return Ok(Replayed::Failed(format!("request {n} ({what}): {}", fault.message)));
                }
            }
        }
    }
    Ok(Replayed::ToTheEnd { requests })
}

/// Returns the SHA-256 of recorded requests, hexadecimal; with it, a truncated or changed copy can be detected.
pub fn digest_of(frames: &[u8]) -> String {
    sha256_hex(frames)
}

/// Checks that recorded requests are complete, and counts them.
///
/// # Errors
/// What is wrong with the requests; the text completes a sentence that begins with the name of their file.
fn whole(frames: &[u8]) -> Result<usize, String> {
    if frames.is_empty() {
        return Err("is empty: no request was recorded".to_owned());
    }
    let (mut stream, mut incoming) = (frames, Incoming::default());
    for n in 1.. {
        match incoming.receive(&mut stream) {
            Received::Frame if n == 1 && incoming.kind() != kind::LOAD => {
                return Err("is damaged: its first request does not load a plugin".to_owned());
            }
            Received::Frame => {}
            Received::Closed if incoming.has_more() => {
                return Err(format!("ends in the middle of request {n}"));
            }
            Received::Closed => return Ok(n - 1),
            Received::Broken => return Err(format!("is damaged at request {n}")),
        }
    }
    unreachable!("the input is finite")
}

/// Returns the plugin file that is named in recorded requests.
pub fn plugin_of(frames: &[u8]) -> Option<PathBuf> {
    loaded(frames, |load| load.path().to_owned())
}

fn memory_limit_of(frames: &[u8]) -> Option<u64> {
    loaded(frames, |load| load.memory_limit_bytes)
}

fn loaded<T>(frames: &[u8], take: impl FnOnce(Load) -> T) -> Option<T> {
    let (mut stream, mut incoming) = (frames, Incoming::default());
    while incoming.receive(&mut stream) == Received::Frame {
        if incoming.kind() == kind::LOAD {
            return Load::read(incoming.body()).ok().flatten().map(take);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::body::Writer;

    fn frame(kind: u8) -> Vec<u8> {
        Writer::default().begin(kind, 1, 250).put("x").finish().expect("short").to_vec()
    }

    #[test]
    fn what_is_empty_cut_or_begins_in_the_middle_is_not_whole() {
        let (load, step) = (frame(kind::LOAD), frame(kind::STEP));
        let both = [load.clone(), step.clone()].concat();
        assert_eq!(whole(&both), Ok(2));
        assert!(whole(&[]).is_err_and(|why| why.starts_with("is empty")));
        for length in 1..both.len() {
            let cut = whole(&both[..length]);
            let n = if length < load.len() { 1 } else { 2 };
            let expected =
                if length == load.len() { Ok(1) } else { Err(format!("ends in the middle of request {n}")) };
            assert_eq!(cut, expected, "{length}");
        }
        assert!(whole(&step).is_err_and(|why| why.contains("does not load a plugin")));
        assert_eq!(whole(&[load, vec![0; 4]].concat()), Err("is damaged at request 2".into()));
    }
}
