//! Limits on threads and processes.

use anyhow::anyhow;
use std::{
    fs,
    sync::{Mutex, PoisonError},
    thread::{self, available_parallelism},
    time::{Duration, Instant},
};

/// The number of threads and processes of a planner, as counted by `prlimit --nproc`: the planner's process, and a
/// thread that ends this process when the program ends.
pub const PLANNER: usize = 2;
/// The thread that waits for signals.
pub const SIGNAL: usize = 1;

/// How long the check waits for the system to release ended threads; even a busy machine needs less.
const CLEARED_WITHIN: Duration = Duration::from_secs(1);
/// The stack of each test thread in bytes; the threads do nothing.
const STACK_BYTES: usize = 64 << 10;

/// The number of threads and processes for this many simultaneous missions without recording; 0: one mission per core.
pub fn missions(at_once: usize) -> usize {
    SIGNAL + (1 + PLANNER) * if at_once > 0 { at_once } else { cores() }
}

/// The number of processor cores that this process can use.
pub fn cores() -> usize {
    available_parallelism().map_or(1, usize::from)
}

/// Checks that the system grants enough threads and processes for a command, before the command starts work that it
/// could not finish. Takes less than a millisecond.
///
/// # Errors
/// The system grants fewer threads and processes than needed.
pub fn check(needed: usize) -> anyhow::Result<()> {
    let before = running();
    let gate = Mutex::new(());
    let closed = gate.lock().unwrap_or_else(PoisonError::into_inner);
    let wait = || drop(gate.lock());
    thread::scope(|scope| {
        let start = |_| thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, wait).map(drop);
        let started = (0..needed).try_for_each(start);
        drop(closed);
        started
    })
    .map_err(|error| {
        anyhow!(
            "this command needs {} threads and processes, but the system grants fewer ({error}); raise the \
             limit with `ulimit -u`",
            needed + 1
        )
    })?;
    // Ended threads still count until the system has released them.
    let until = Instant::now() + CLEARED_WITHIN;
    while running() > before && Instant::now() < until {
        thread::sleep(Duration::from_micros(50));
    }
    Ok(())
}

/// The number of threads of this process, if the system reports it.
fn running() -> usize {
    fs::read_dir("/proc/self/task").map_or(0, Iterator::count)
}
