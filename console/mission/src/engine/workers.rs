//! The numbers of workers, the workers to be closed, and the plugins that have failed too often.

mod quarantine;

use crate::ask::{Ask, AskId, What, WorkerId};
pub(super) use quarantine::{MOST_FAULTS, Quarantine, WINDOW_S};
use std::collections::VecDeque;

/// The workers of a mission.
#[derive(Clone, Default)]
pub(super) struct Workers {
    next: u16,
    closing: VecDeque<WorkerId>,
    pub quarantine: Quarantine,
}

impl Workers {
    /// A number that no worker has had before.
    pub(super) fn next(&mut self) -> WorkerId {
        self.next = self.next.wrapping_add(1);
        WorkerId(self.next)
    }

    /// Marks a worker to be closed.
    pub(super) fn close(&mut self, worker: Option<WorkerId>) {
        self.closing.extend(worker);
    }

    /// The next worker to be closed, as an ask that has no answer.
    pub(super) fn poll(&mut self) -> Option<Ask> {
        let worker = self.closing.pop_front()?;
        Some(Ask { id: AskId { worker, n: u32::MAX }, what: What::Close })
    }
}
