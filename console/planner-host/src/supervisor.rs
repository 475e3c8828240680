//! The console's side of workers: starts them, asks them, and turns every way to fail into a [`Failure`].
//!
//! Nothing here waits but [`wait`], for all workers at once.

mod clock;
mod ending;
mod lines;
mod load;
mod poller;
mod process;
mod ready;
mod tape;
mod waker;
mod worker;

pub use waker::Waker;
pub(crate) use {
    poller::{wait, wait_for_one},
    ready::Ready,
    waker::WakeReceiver,
    worker::Worker,
};

use crate::wire::answer::{BAD_OUTPUT, Refusal};
use planner_api::Code;
use std::ffi::OsString;
use std::io;
use std::path::PathBuf;
use std::time::Duration;

/// How to start a worker: a program that ends in [`crate::worker_main`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WorkerCommand {
    /// The program.
    pub program: PathBuf,
    /// Its command-line arguments.
    pub arguments: Vec<OsString>,
}

impl WorkerCommand {
    /// Runs another program with the argument `worker`.
    pub fn new(program: impl Into<PathBuf>) -> Self {
        Self { program: program.into(), arguments: vec!["worker".into()] }
    }
}

impl Default for WorkerCommand {
    /// This very program with the argument `worker`. On Linux the file that is running, even if another was put in
    /// its place, so that console and worker are always the same build.
    fn default() -> Self {
        let running = PathBuf::from("/proc/self/exe");
        let is_there = cfg!(target_os = "linux") && running.exists();
        Self::new(if is_there { running } else { std::env::current_exe().unwrap_or(running) })
    }
}

/// The deadline that a planner sees. It is earlier than the enforced one, so that a planner that watches its time still
/// answers before it is killed.
fn soft(deadline: Duration) -> Duration {
    deadline * 9 / 10
}

/// Why there is no answer. All texts read on after the name of the planner or plugin.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Failure {
    /// The planner said no.
    Planner(Refusal),
    /// The loader said no.
    Refused(String),
    /// The process ended; how.
    Died {
        /// "was killed by ..." and the like.
        how: String,
        /// The last line that it printed; may be empty.
        last_output: String,
    },
    /// It tried to do something that no planner may do; the process was killed.
    Forbidden {
        /// What.
        call: String,
        /// The last line that it printed; may be empty.
        last_output: String,
    },
    /// No answer within the budget and the grace period; the process was killed.
    Hung,
    /// An answer, but only within the grace period; the process was killed.
    Late,
    /// It was starved of CPU time for too long; the process was killed.
    Starved,
    /// It exceeded this limit of memory, bytes; the process was killed.
    Overweight(u64),
    /// An invalid answer; the process was killed.
    Protocol,
    /// The process no longer exists.
    Gone,
    /// A worker could not be started, or the request is too long for it.
    Console(String),
}

/// What a process did that exceeded this limit of memory, bytes; reads on after the planner's name.
pub(crate) fn overweight(limit: u64) -> String {
    format!("took more than its limit of {} MB of memory", limit >> 20)
}

/// Why a worker cannot run: what failed with its process, and what would help.
pub(crate) fn no_worker(cannot: &str, error: &io::Error) -> String {
    // What fork and clone report at the limit of processes and threads.
    let limit = if error.kind() == io::ErrorKind::WouldBlock {
        "; `ulimit -u` limits processes and threads"
    } else {
        ""
    };
    format!("cannot be run, its process {cannot}: {error}{limit}")
}

impl Failure {
    /// Whether the process has ended as well, by itself or killed for what it did.
    pub(crate) fn has_ended_the_process(&self) -> bool {
        matches!(
            self,
            Self::Died { .. }
                | Self::Forbidden { .. }
                | Self::Hung
                | Self::Late
                | Self::Overweight(_)
                | Self::Protocol
                | Self::Gone
        )
    }

    /// How the process ended; reads on after the planner's name.
    pub(crate) fn how(&self) -> String {
        match self {
            Self::Died { how, .. } => how.clone(),
            Self::Forbidden { call, .. } => format!("tried {call}, which no planner may do,"),
            Self::Overweight(limit) => overweight(*limit),
            Self::Protocol => "sent an invalid reply".to_owned(),
            _ => "did not end in time".to_owned(),
        }
    }

    /// Whether the planner cannot be asked again after this, or ran out of time: then its process ends.
    fn ends_the_process(&self) -> bool {
        let Self::Planner(refusal) = self else { return false };
        match Code::from_number(refusal.code) {
            Some(code) => matches!(code, Code::Panic | Code::Poisoned | Code::Timeout | Code::Cancelled),
            None => refusal.code != BAD_OUTPUT,
        }
    }
}
