//! The message queue of the drawing thread. Urgent messages (keys, signals) are delivered before all others, and
//! senders never block.

use std::{
    collections::VecDeque,
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};
use tui::{Msg, RunId, RunMsg};

#[derive(Default)]
struct Shared {
    queues: Mutex<Queues>,
    arrived: Condvar,
}

#[derive(Default)]
struct Queues {
    urgent: VecDeque<Msg>,
    normal: VecDeque<Msg>,
    is_closed: bool,
}

impl Shared {
    fn queues(&self) -> MutexGuard<'_, Queues> {
        // A poisoned lock is harmless: no statement leaves a queue incomplete.
        self.queues.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The receiving end; once it is dropped, messages are discarded.
pub(super) struct Inbox(Arc<Shared>);

/// The sending end; any number of threads can use it.
#[derive(Clone)]
pub(super) struct Outbox(Arc<Shared>);

/// A sending end that tags each message with its run.
#[derive(Clone)]
pub(super) struct RunOutbox {
    pub run: RunId,
    pub outbox: Outbox,
}

impl RunOutbox {
    /// Sends a message that is delivered before all others. Returns `false` if the inbox is closed.
    pub(super) fn send_urgent(&self, msg: RunMsg) -> bool {
        self.outbox.send_urgent(Msg::Run(self.run, msg))
    }

    /// Sends a normal message. Returns `false` if the inbox is closed.
    pub(super) fn send(&self, msg: RunMsg) -> bool {
        self.outbox.send(Msg::Run(self.run, msg))
    }

    /// The number of normal messages waiting.
    pub(super) fn backlog(&self) -> usize {
        self.outbox.backlog()
    }
}

/// Creates a connected pair of ends.
pub(super) fn inbox() -> (Outbox, Inbox) {
    let shared = Arc::new(Shared::default());
    (Outbox(Arc::clone(&shared)), Inbox(shared))
}

impl Outbox {
    /// Sends a message that is delivered before all others: a key, a signal, a failure. Returns `false` if the inbox is
    /// closed.
    pub(super) fn send_urgent(&self, msg: Msg) -> bool {
        self.put(|queues| queues.urgent.push_back(msg))
    }

    /// Sends a normal message. Returns `false` if the inbox is closed.
    pub(super) fn send(&self, msg: Msg) -> bool {
        self.put(|queues| queues.normal.push_back(msg))
    }

    /// The number of normal messages waiting.
    pub(super) fn backlog(&self) -> usize {
        self.0.queues().normal.len()
    }

    fn put(&self, put: impl FnOnce(&mut Queues)) -> bool {
        let mut queues = self.0.queues();
        if queues.is_closed {
            return false;
        }
        put(&mut queues);
        drop(queues);
        self.0.arrived.notify_one();
        true
    }
}

impl Inbox {
    /// Takes the next message; urgent messages come first. Waits until the given time; if none is given, waits
    /// indefinitely.
    pub(super) fn next(&self, until: Option<Instant>) -> Option<Msg> {
        let mut queues = self.0.queues();
        loop {
            let next = queues.urgent.pop_front().or_else(|| queues.normal.pop_front());
            if next.is_some() {
                return next;
            }
            queues = match until.map(|until| until.saturating_duration_since(Instant::now())) {
                Some(Duration::ZERO) => return None,
                Some(left) => {
                    self.0.arrived.wait_timeout(queues, left).unwrap_or_else(PoisonError::into_inner).0
                }
                None => self.0.arrived.wait(queues).unwrap_or_else(PoisonError::into_inner),
            };
        }
    }
}

impl Drop for Inbox {
    fn drop(&mut self) {
        let mut queues = self.0.queues();
        queues.is_closed = true;
        (queues.urgent, queues.normal) = (VecDeque::new(), VecDeque::new());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tui::Signal;

    const EVENTS: Msg = Msg::Run(RunId(1), RunMsg::Events(Vec::new()));

    #[test]
    fn a_key_overtakes_all_other_messages_and_senders_never_wait() {
        let (outbox, inbox) = inbox();
        for _ in 0..10_000 {
            assert!(outbox.send(EVENTS));
        }
        assert!(outbox.send_urgent(Msg::Signal(Signal::Interrupt)));
        assert_eq!(outbox.backlog(), 10_000);
        let next = || inbox.next(Some(Instant::now()));
        assert_eq!(next(), Some(Msg::Signal(Signal::Interrupt)));
        assert_eq!(next(), Some(EVENTS));
    }

    #[test]
    fn a_closed_inbox_takes_no_more_messages() {
        let (outbox, inbox) = inbox();
        drop(inbox);
        assert!(!outbox.send(EVENTS));
        assert_eq!(outbox.backlog(), 0);
    }
}
