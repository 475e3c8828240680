//! The console's side of workers: starts them, sends them requests, and turns every kind of failure into a [`Failure`].
//!
//! Only [`wait`] waits, for all workers at the same time.

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

/// The command that starts a worker: a program that eventually calls [`crate::worker_main`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WorkerCommand {
    /// The program.
    pub program: PathBuf,
    /// The command-line arguments.
    pub arguments: Vec<OsString>,
}

impl WorkerCommand {
    /// Runs a different program with the argument `worker`.
    pub fn new(program: impl Into<PathBuf>) -> Self {
        Self { program: program.into(), arguments: vec!["worker".into()] }
    }
}

impl Default for WorkerCommand {
    /// Runs this same program with the argument `worker`. On Linux, this is the very file that is running, even if
    /// it has been replaced on disk, so that console and worker are always the same build.
    fn default() -> Self {
        let running = PathBuf::from("/proc/self/exe");
        let is_there = cfg!(target_os = "linux") && running.exists();
        Self::new(if is_there { running } else { std::env::current_exe().unwrap_or(running) })
    }
}

/// Returns the deadline that a planner sees. It is earlier than the enforced deadline, so a planner that watches its
/// time can still answer before it is killed.
fn soft(deadline: Duration) -> Duration {
    deadline * 9 / 10
}

/// The reason why a request has no answer. Every text completes a sentence that begins with the name of the planner or
/// plugin.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Failure {
    /// The planner refused the request.
    Planner(Refusal),
    /// The loader refused the plugin.
    Refused(String),
    /// The process ended.
    Died {
        /// How it ended, such as "was killed by ...".
        how: String,
        /// The last line that the process printed; may be empty.
        last_output: String,
    },
    /// The planner tried something that no planner may do, and the process was killed.
    Forbidden {
        /// What the planner tried.
        call: String,
        /// The last line that the process printed; may be empty.
        last_output: String,
    },
    /// There was no answer within the budget and the grace period, and the process was killed.
    Hung,
    /// The answer came only in the grace period, and the process was killed.
    Late,
    /// The worker was starved of CPU time for too long, and the process was killed.
    Starved,
    /// The worker exceeded this memory limit, bytes, and the process was killed.
    Overweight(u64),
    /// The answer was invalid, and the process was killed.
    Protocol,
    /// The process no longer exists.
    Gone,
    /// A worker could not be started, or the request is too long for it.
    Console(String),
}

/// States that a process exceeded this memory limit, bytes. The text completes a sentence that begins with the
/// planner's name.
pub(crate) fn overweight(limit: u64) -> String {
    format!("exceeded its memory limit of {} MB", limit >> 20)
}

/// Explains why a worker cannot run: what failed, and what would help.
pub(crate) fn no_worker(cannot: &str, error: &io::Error) -> String {
    // This is the error of fork and clone when the limit of processes and threads is reached.
    let limit = if error.kind() == io::ErrorKind::WouldBlock {
        "; `ulimit -u` limits processes and threads"
    } else {
        ""
    };
    format!("cannot be run: its process {cannot}: {error}{limit}")
}

impl Failure {
    /// Whether the process has ended as well, either on its own or because it was killed after the failure.
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

    /// Describes how the process ended. The text completes a sentence that begins with the planner's name.
    pub(crate) fn how(&self) -> String {
        match self {
            Self::Died { how, .. } => how.clone(),
            Self::Forbidden { call, .. } => format!("tried a forbidden system call ({call})"),
            Self::Overweight(limit) => overweight(*limit),
            Self::Protocol => "sent an invalid reply".to_owned(),
            _ => "did not exit in time".to_owned(),
        }
    }

    /// Whether the planner, after this refusal, can no longer be asked or has run out of time; if so, its process is
    /// killed.
    fn ends_the_process(&self) -> bool {
        let Self::Planner(refusal) = self else { return false };
        match Code::from_number(refusal.code) {
            Some(code) => matches!(code, Code::Panic | Code::Poisoned | Code::Timeout | Code::Cancelled),
            None => refusal.code != BAD_OUTPUT,
        }
    }
}
