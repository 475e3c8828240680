//! What the drawing thread is told: urgent messages (keys, signals) before all news, and nobody who tells ever waits.

use std::{
    collections::VecDeque,
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};
use tui::Msg;

#[derive(Default)]
struct Shared {
    queues: Mutex<Queues>,
    arrived: Condvar,
}

#[derive(Default)]
struct Queues {
    urgent: VecDeque<Told>,
    news: VecDeque<Msg>,
    is_closed: bool,
}

impl Shared {
    fn queues(&self) -> MutexGuard<'_, Queues> {
        // A queue is whole between any two statements.
        self.queues.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A message, and whether the thread that heard of it has stopped the robot already.
#[derive(Debug, PartialEq)]
pub struct Told {
    pub msg: Msg,
    pub is_stopped: bool,
}

/// The receiving end; telling is in vain once it is gone.
pub struct Inbox(Arc<Shared>);

/// The telling end, for any number of threads.
#[derive(Clone)]
pub struct Outbox(Arc<Shared>);

/// A pair of ends.
pub fn inbox() -> (Outbox, Inbox) {
    let shared = Arc::new(Shared::default());
    (Outbox(Arc::clone(&shared)), Inbox(shared))
}

impl Outbox {
    /// Tells what comes before all news: keys, signals, failures. `false` if nobody listens any more.
    pub fn urge(&self, msg: Msg) -> bool {
        self.put(|queues| queues.urgent.push_back(Told { msg, is_stopped: false }))
    }

    /// The same of what has stopped the robot already, so that it is not stopped twice.
    pub fn urge_stopped(&self, msg: Msg) -> bool {
        self.put(|queues| queues.urgent.push_back(Told { msg, is_stopped: true }))
    }

    /// Tells news. `false` if nobody listens any more.
    pub fn tell(&self, msg: Msg) -> bool {
        self.put(|queues| queues.news.push_back(msg))
    }

    /// How much news waits.
    pub fn backlog(&self) -> usize {
        self.0.queues().news.len()
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
    /// The next message, the most urgent first; waits until a moment, or for as long as it takes.
    pub fn next(&self, until: Option<Instant>) -> Option<Told> {
        let mut queues = self.0.queues();
        loop {
            let news = |queues: &mut Queues| Some(Told { msg: queues.news.pop_front()?, is_stopped: false });
            let next = queues.urgent.pop_front().or_else(|| news(&mut queues));
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
        (queues.urgent, queues.news) = (VecDeque::new(), VecDeque::new());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tui::Signal;

    #[test]
    fn a_key_overtakes_all_news_and_telling_never_waits() {
        let (outbox, inbox) = inbox();
        for _ in 0..10_000 {
            assert!(outbox.tell(Msg::Events(Vec::new())));
        }
        assert!(outbox.urge(Msg::Signal(Signal::Interrupt)));
        assert_eq!(outbox.backlog(), 10_000);
        let next = || inbox.next(Some(Instant::now())).map(|told| told.msg);
        assert_eq!(next(), Some(Msg::Signal(Signal::Interrupt)));
        assert_eq!(next(), Some(Msg::Events(Vec::new())));
    }

    #[test]
    fn an_inbox_that_is_gone_takes_no_more() {
        let (outbox, inbox) = inbox();
        drop(inbox);
        assert!(!outbox.tell(Msg::Events(Vec::new())));
        assert_eq!(outbox.backlog(), 0);
    }
}
