//! The data shared between the writing thread and all others.

use std::{
    sync::{Mutex, MutexGuard, PoisonError, atomic::AtomicU64},
    time::Instant,
};

/// Counters shared between the thread and all others.
#[derive(Default)]
pub(super) struct Shared {
    pub sent: AtomicU64,
    pub done: AtomicU64,
    pub journal_bytes: AtomicU64,
    /// Errors that cause loss of data; each is listed once.
    losses: Mutex<Vec<String>>,
    /// The current problem, which may pass.
    trouble: Mutex<Option<String>>,
    /// Deadline for merging the chunks of the recording, once a caller waits for the end.
    merge_until: Mutex<Option<Instant>>,
}

impl Shared {
    pub(super) fn lose(&self, error: &impl ToString) {
        let (mut losses, error) = (locked(&self.losses), error.to_string());
        if !losses.contains(&error) {
            losses.push(error);
        }
    }

    pub(super) fn set_trouble(&self, trouble: Option<String>) {
        *locked(&self.trouble) = trouble;
    }

    pub(super) fn set_merge_until(&self, until: Instant) {
        *locked(&self.merge_until) = Some(until);
    }

    pub(super) fn merge_until(&self) -> Option<Instant> {
        *locked(&self.merge_until)
    }

    pub(super) fn error(&self) -> Option<String> {
        let mut errors = locked(&self.losses).clone();
        let trouble = locked(&self.trouble).clone();
        // The error of a file that has ended is in both lists: state it only once.
        errors.extend(trouble.filter(|trouble| !errors.contains(trouble)));
        (!errors.is_empty()).then(|| errors.join("; "))
    }
}

/// No panic can leave the shared data inconsistent.
fn locked<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
