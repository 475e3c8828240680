//! The threads and processes that the system grants.

use anyhow::anyhow;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Threads and processes that a command has at once at most, about: the recorder, the recording SDK, the planners.
const NEEDED: usize = 16;
/// They do nothing.
const STACK_BYTES: usize = 64 << 10;

/// Makes sure that the system grants what a command needs, before it begins something that it could not end. Takes less than a
/// millisecond.
///
/// # Errors
/// It does not; the sentence names the limit.
pub(crate) fn check() -> anyhow::Result<()> {
    let gate = Mutex::new(());
    let closed = gate.lock().unwrap_or_else(PoisonError::into_inner);
    let wait = || drop(gate.lock());
    thread::scope(|scope| {
        let start = |_| thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, wait).map(drop);
        let started = (0..NEEDED).try_for_each(start);
        drop(closed);
        started
    })
    .map_err(|error| {
        anyhow!(
            "the system grants fewer than {NEEDED} threads and processes ({error}): `ulimit -u` limits them"
        )
    })
}
