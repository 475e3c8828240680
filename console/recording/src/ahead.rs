//! A queue between a thread that reads ahead and its consumer. The limit is on the weight of the items, not on their
//! number: a journal may contain millions of small events, and a few large ones.

use std::{
    collections::VecDeque,
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
};

/// Creates a queue for items up to this total weight, or for a single heavier item.
pub fn queue<T>(most: u64) -> (Giver<T>, Taker<T>) {
    let shared = Arc::new(Shared { state: Mutex::default(), changed: Condvar::new(), most });
    (Giver(Arc::clone(&shared)), Taker(shared))
}

/// Adds items to a queue.
pub struct Giver<T>(Arc<Shared<T>>);

/// Takes items from a queue in order, until the sender is dropped.
pub struct Taker<T>(Arc<Shared<T>>);

struct Shared<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
    most: u64,
}

struct State<T> {
    items: VecDeque<(T, u64)>,
    weight: u64,
    is_closed: bool,
}

impl<T> Default for State<T> {
    fn default() -> Self {
        Self { items: VecDeque::new(), weight: 0, is_closed: false }
    }
}

impl<T> Shared<T> {
    fn state(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(&self, state: MutexGuard<'a, State<T>>) -> MutexGuard<'a, State<T>> {
        self.changed.wait(state).unwrap_or_else(PoisonError::into_inner)
    }

    fn close(&self) {
        self.state().is_closed = true;
        self.changed.notify_all();
    }
}

impl<T> Giver<T> {
    /// Waits for space and adds an item; returns `false` if the receiver is gone.
    pub fn give(&self, item: T, weight: u64) -> bool {
        let mut state = self.0.state();
        while !state.is_closed && state.weight > 0 && state.weight + weight > self.0.most {
            state = self.0.wait(state);
        }
        if state.is_closed {
            return false;
        }
        state.weight += weight;
        state.items.push_back((item, weight));
        self.0.changed.notify_all();
        true
    }
}

impl<T> Iterator for Taker<T> {
    type Item = T;

    fn next(&mut self) -> Option<T> {
        let mut state = self.0.state();
        loop {
            if let Some((item, weight)) = state.items.pop_front() {
                state.weight -= weight;
                self.0.changed.notify_all();
                return Some(item);
            }
            if state.is_closed {
                return None;
            }
            state = self.0.wait(state);
        }
    }
}

impl<T> Drop for Giver<T> {
    fn drop(&mut self) {
        self.0.close();
    }
}

impl<T> Drop for Taker<T> {
    fn drop(&mut self) {
        self.0.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{
        sync::atomic::{AtomicU64, Ordering},
        thread,
    };

    #[test]
    fn all_items_arrive_in_order_and_the_queue_stays_within_its_weight() {
        let (giver, taker) = queue::<u64>(10);
        let (given, mut taken) = (Arc::new(AtomicU64::new(0)), 0);
        let giving = {
            let given = Arc::clone(&given);
            thread::spawn(move || {
                // Every tenth item is heavier than the whole queue may be.
                (0..500).all(|n| {
                    giver.give(n, if n % 10 == 9 { 25 } else { 3 }) && {
                        given.fetch_add(1, Ordering::SeqCst);
                        true
                    }
                })
            })
        };
        for (expected, item) in (0..).zip(taker) {
            taken += 1;
            assert_eq!(item, expected);
            assert!(
                given.load(Ordering::SeqCst) <= taken + 4,
                "three items of 3 and one that was just taken"
            );
        }
        assert!(giving.join().is_ok_and(|all| all) && taken == 500);
    }

    #[test]
    fn who_gives_hears_that_nobody_takes_any_more() {
        let (giver, taker) = queue(1);
        assert!(giver.give((), 5));
        let giving = thread::spawn(move || giver.give((), 5));
        drop(taker);
        assert!(giving.join().is_ok_and(|was_taken| !was_taken));
    }
}
