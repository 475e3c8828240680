//! The console's side of a worker: starts it, asks it, and turns every way to fail into a [`Failure`].

#[cfg(unix)]
mod child;
#[cfg(unix)]
mod ending;
#[cfg(unix)]
mod handle;
#[cfg(not(unix))]
mod nowhere;

#[cfg(unix)]
pub(crate) use handle::Worker;
#[cfg(not(unix))]
pub(crate) use nowhere::Worker;

use crate::wire::answer::Refusal;
use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

/// How to start a worker: a program that ends in [`crate::worker_main`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WorkerCommand {
    /// The program.
    pub program: PathBuf,
    /// What it is told.
    pub arguments: Vec<OsString>,
}

impl WorkerCommand {
    /// Another program with the argument `worker`.
    pub fn new(program: impl Into<PathBuf>) -> Self {
        Self { program: program.into(), arguments: vec!["worker".into()] }
    }
}

impl Default for WorkerCommand {
    /// This very program with the argument `worker`. On Linux the file that is running, even if another was put in
    /// its place, so that console and worker are always of one build.
    fn default() -> Self {
        let running = PathBuf::from("/proc/self/exe");
        let is_there = cfg!(target_os = "linux") && running.exists();
        Self::new(if is_there { running } else { std::env::current_exe().unwrap_or(running) })
    }
}

/// After its deadline a worker is asked to stop and given this long before it is killed.
#[cfg(unix)]
const GRACE: Duration = Duration::from_millis(30);

/// Planners are told a deadline that is this much earlier than the one they are held to, so that one that minds its
/// time still answers in time.
#[cfg(unix)]
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
    /// No answer within deadline and grace; the process was killed.
    Hung,
    /// Nobody wants the plan any more.
    Stopped,
    /// An answer, but only within the grace.
    Late,
    /// An answer that is none; the process was killed.
    Protocol,
    /// There is no process any more.
    Gone,
    /// A worker could not be started, or the request is too long for it.
    Console(String),
}
