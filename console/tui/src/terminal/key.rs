//! The keyboard: which key last went down, and when.

use super::decode::Input;
use crate::keys::{Key, KeyPress};
use std::time::Instant;

/// The state of the keyboard.
#[derive(Debug, Default)]
pub struct Keyboard {
    last: Option<(Key, Instant)>,
}

impl Keyboard {
    /// Completes a key press with the time since the same key last went down, and with the number of the last frame
    /// drawn before the press. `None` for input that is not a press; the press after such input is treated as new.
    pub fn take(&mut self, input: &Input, now: Instant, seen: u64) -> Option<KeyPress> {
        let last = self.last.take();
        let Input::Key(press) = input else { return None };
        self.last = Some((press.key, now));
        let same = last.filter(|(key, _)| *key == press.key);
        let since_same = same.map(|(_, at)| now.saturating_duration_since(at));
        Some(KeyPress { since_same, seen: Some(seen), ..*press })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::Freshness;
    use std::time::Duration;

    #[test]
    #[allow(clippy::disallowed_methods, reason = "any time will do")]
    fn a_press_knows_how_long_after_the_same_key_it_came() {
        let (mut keyboard, began) = (Keyboard::default(), Instant::now());
        let mut since = |input: Input, at_ms| {
            let press = keyboard.take(&input, began + Duration::from_millis(at_ms), 7);
            assert!(press.is_none_or(|press| press.seen == Some(7)));
            press.map(|press| (press.since_same.map(|passed| passed.as_millis()), press.freshness()))
        };
        let press = |letter| Input::Key(Key::Char(letter).into());
        let repeat = Input::Key(KeyPress { repeat: true, ..Key::Char('.').into() });
        assert_eq!(since(press('.'), 0), Some((None, Freshness::Fresh)));
        assert_eq!(since(press('.'), 500), Some((Some(500), Freshness::Unclear)));
        assert_eq!(since(press('.'), 533), Some((Some(33), Freshness::Held)));
        assert_eq!(since(press('.'), 3000), Some((Some(2467), Freshness::Fresh)));
        assert_eq!(since(press('x'), 3010), Some((None, Freshness::Fresh)));
        assert_eq!(since(press('.'), 3020), Some((None, Freshness::Fresh)));
        assert_eq!(since(repeat, 9000), Some((Some(5980), Freshness::Held)));
        // If the terminal reports that the key was released, the next press is a fresh one.
        assert_eq!(since(Input::OtherKey, 9010), None);
        assert_eq!(since(press('.'), 9020), Some((None, Freshness::Fresh)));
    }
}
