//! Work on separate threads. A result counts only until newer work of the same kind begins.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Counts pieces of work of one kind.
#[derive(Default)]
pub(super) struct Newest(Arc<Mutex<u64>>);

/// The number of a piece of work.
pub(super) struct Turn {
    n: u64,
    newest: Arc<Mutex<u64>>,
}

impl Newest {
    /// Begins a piece of work; the results of all earlier ones no longer count.
    pub(super) fn begin(&self) -> Turn {
        let mut newest = locked(&self.0);
        *newest += 1;
        Turn { n: *newest, newest: Arc::clone(&self.0) }
    }

    /// Drops the results of all work so far.
    pub(super) fn outdate(&self) {
        self.begin();
    }
}

impl Turn {
    /// Whether no newer work has begun.
    pub(super) fn is_newest(&self) -> bool {
        *locked(&self.newest) == self.n
    }

    /// Sends a result unless newer work has begun. A newer result is always sent after an older one.
    pub(super) fn give(&self, send: impl FnOnce()) {
        let newest = locked(&self.newest);
        if *newest == self.n {
            send();
        }
    }
}

fn locked(newest: &Mutex<u64>) -> MutexGuard<'_, u64> {
    // A poisoned lock is harmless: a number is never incomplete.
    newest.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_newest_work_gives_results_however_late_the_others_are() {
        let newest = Newest::default();
        let (first, second) = (newest.begin(), newest.begin());
        let mut given = Vec::new();
        second.give(|| given.push("second"));
        first.give(|| given.push("first, late"));
        second.give(|| given.push("the second's other result"));
        newest.outdate();
        second.give(|| given.push("second, late"));
        assert_eq!(given, ["second", "the second's other result"]);
    }
}
