//! What the writing thread and everyone else share.

use std::{
    sync::{Mutex, MutexGuard, PoisonError, atomic::AtomicU64},
    time::Instant,
};

/// Figures that the thread and everyone else share.
#[derive(Default)]
pub(super) struct Shared {
    pub sent: AtomicU64,
    pub done: AtomicU64,
    pub journal_bytes: AtomicU64,
    /// Errors with which something is lost, each once.
    losses: Mutex<Vec<String>>,
    /// What is wrong now and may be over later.
    trouble: Mutex<Option<String>>,
    /// Until when the chunks of the recording may be merged, once somebody waits for the end.
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
        // A file that has ended is also in trouble.
        errors.extend(trouble.filter(|trouble| !errors.contains(trouble)));
        (!errors.is_empty()).then(|| errors.join("; "))
    }
}

/// What is shared holds no invariant that a panic could break.
fn locked<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
