//! The threads and processes that the system grants.

use anyhow::anyhow;
use std::{
    fs,
    sync::{Mutex, PoisonError},
    thread::{self, available_parallelism},
    time::{Duration, Instant},
};

/// A planner: its process, and the thread in it that ends it with the program. Counted with `prlimit --nproc`.
pub const PLANNER: usize = 2;
/// Who waits for a signal.
pub const SIGNAL: usize = 1;

/// Within this the system has cleared away threads that have ended, even on a busy machine.
const CLEARED_WITHIN: Duration = Duration::from_secs(1);
/// They do nothing.
const STACK_BYTES: usize = 64 << 10;

/// Threads and processes of missions that are flown at once without being recorded; 0: one for each core.
pub fn missions(at_once: usize) -> usize {
    SIGNAL + (1 + PLANNER) * if at_once > 0 { at_once } else { cores() }
}

/// Processor cores that this process may use.
pub fn cores() -> usize {
    available_parallelism().map_or(1, usize::from)
}

/// Makes sure that the system grants what a command needs, before it begins something that it could not end. Takes less than a
/// millisecond.
///
/// # Errors
/// It does not; the sentence names the limit.
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
            "this command needs {} threads and processes, and the system grants fewer ({error}): `ulimit -u` limits them",
            needed + 1
        )
    })?;
    // Who has ended counts until the system has cleared it away.
    let until = Instant::now() + CLEARED_WITHIN;
    while running() > before && Instant::now() < until {
        thread::sleep(Duration::from_micros(50));
    }
    Ok(())
}

/// Threads of this process, where the system says so.
fn running() -> usize {
    fs::read_dir("/proc/self/task").map_or(0, Iterator::count)
}
