//! Whether a space is text or HOLD, as far as the thread that reads keys can know.
//!
//! The screen reports whether an input line is open, but a burst of keys arrives faster than the screen takes it: in
//! `:speed 2`, read from the terminal at once, the space is read before the screen has opened the line. The thread
//! therefore follows the keys that the screen has not taken yet. In doubt, the thread treats a space as HOLD. In any
//! case, the screen holds the robot when it takes a space outside a line.

use std::{
    collections::VecDeque,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};
use tui::{Key, Msg};

/// A key opens a line only for what follows within this time, unless the screen confirms it: if the screen hangs, the
/// space must hold again.
const UNCONFIRMED: Duration = Duration::from_secs(2);

/// What the screen last reported.
#[derive(Clone, Default)]
pub(super) struct Reports(Arc<Mutex<Report>>);

#[derive(Clone, Copy, Default)]
struct Report {
    /// The number of inputs that the screen has taken.
    taken: u64,
    /// Whether an input line is open after these inputs.
    is_typing: bool,
}

impl Reports {
    /// Records whether an input line is open after a message; `is_input` states whether the message came from the
    /// terminal.
    pub(super) fn report(&self, is_input: bool, is_typing: bool) {
        let mut report = self.lock();
        report.taken += u64::from(is_input);
        report.is_typing = is_typing;
    }

    fn lock(&self) -> MutexGuard<'_, Report> {
        // A poisoned lock is harmless: no statement leaves a report incomplete.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Whether a message comes from the terminal, so that the screen counts it as taken.
pub(super) fn is_input(msg: &Msg) -> bool {
    matches!(msg, Msg::Key(_) | Msg::Stop | Msg::Paste(_) | Msg::Mouse(_))
}

/// Follows the keys that the screen has not taken yet.
pub(super) struct Follower {
    reports: Reports,
    /// The keys that open an input line.
    openers: Vec<Key>,
    /// The number of inputs sent to the screen.
    sent: u64,
    /// The keys sent to the screen that may open or close a line: their number among the inputs, and when they came.
    ahead: VecDeque<(u64, Key, Instant)>,
}

impl Follower {
    /// Creates a follower; `openers` are the keys that open an input line.
    pub(super) fn new(reports: Reports, openers: Vec<Key>) -> Self {
        Self { reports, openers, sent: 0, ahead: VecDeque::new() }
    }

    /// Whether a space that arrives now belongs to an input line.
    pub(super) fn is_typing(&mut self, now: Instant) -> bool {
        let report = *self.reports.lock();
        self.ahead.retain(|(number, ..)| *number > report.taken);
        self.ahead.iter().fold(report.is_typing, |is_typing, (_, key, at)| {
            if is_typing {
                !closes(*key)
            } else {
                self.openers.contains(key) && now.duration_since(*at) < UNCONFIRMED
            }
        })
    }

    /// Notes a message that is about to be sent to the screen.
    pub(super) fn sends(&mut self, msg: &Msg, now: Instant) {
        self.sent += u64::from(is_input(msg));
        if let Msg::Key(press) = msg
            && (closes(press.key) || self.openers.contains(&press.key))
        {
            self.ahead.push_back((self.sent, press.key, now));
        }
    }
}

/// Whether a key may close an input line.
fn closes(key: Key) -> bool {
    matches!(key, Key::Enter | Key::Esc | Key::Ctrl(_))
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Burst {
        follower: Follower,
        reports: Reports,
        began: Instant,
    }

    impl Burst {
        fn new() -> Self {
            let reports = Reports::default();
            let follower = Follower::new(reports.clone(), vec![Key::Char(':'), Key::Char('/')]);
            Self { follower, reports, began: Instant::now() }
        }

        /// Reads keys; returns whether each space among them would be text.
        fn read(&mut self, keys: &[Key]) -> Vec<bool> {
            let mut spaces = Vec::new();
            for key in keys {
                if *key == Key::Char(' ') {
                    spaces.push(self.follower.is_typing(self.began));
                }
                self.follower.sends(&Msg::Key((*key).into()), self.began);
            }
            spaces
        }

        fn type_text(&mut self, text: &str) -> Vec<bool> {
            let keys = text.chars().map(|letter| if letter == '\r' { Key::Enter } else { Key::Char(letter) });
            self.read(&keys.collect::<Vec<_>>())
        }
    }

    #[test]
    fn a_space_in_a_line_that_the_same_burst_has_opened_is_text() {
        let mut burst = Burst::new();
        assert_eq!(burst.type_text(":speed 2\r :mark a b\r /x y"), [true, false, true, true, false, true]);
    }

    #[test]
    fn a_space_outside_a_line_holds() {
        let mut burst = Burst::new();
        assert_eq!(burst.type_text(" speed 2 "), [false, false, false]);
        assert_eq!(burst.read(&[Key::Char(':'), Key::Esc, Key::Char(' ')]), [false]);
        assert_eq!(burst.read(&[Key::Char(':'), Key::Ctrl('c'), Key::Char(' ')]), [false]);
    }

    #[test]
    fn the_screen_has_the_last_word_on_the_keys_that_it_has_taken() {
        let mut burst = Burst::new();
        burst.read(&[Key::Char(':')]);
        // The screen has refused to open the line.
        burst.reports.report(true, false);
        assert!(!burst.follower.is_typing(burst.began));
        // The screen has opened a line in another way.
        burst.reports.report(false, true);
        assert!(burst.follower.is_typing(burst.began));
        // Enter may close the line, but the screen has not taken Enter yet. The screen then reports that the line is
        // still open.
        burst.read(&[Key::Enter]);
        assert!(!burst.follower.is_typing(burst.began));
        burst.reports.report(true, true);
        assert!(burst.follower.is_typing(burst.began));
    }

    #[test]
    fn a_screen_that_hangs_cannot_keep_the_space_from_holding() {
        let mut burst = Burst::new();
        burst.read(&[Key::Char(':')]);
        assert!(burst.follower.is_typing(burst.began + UNCONFIRMED / 2));
        assert!(!burst.follower.is_typing(burst.began + UNCONFIRMED));
    }
}
