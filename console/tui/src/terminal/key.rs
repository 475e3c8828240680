//! Converts keys from the terminal library into the console's own.

use crate::keys::{Key, KeyPress};
use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use std::time::Instant;

/// The keyboard state: which key last went down, and when.
#[derive(Debug, Default)]
pub struct Keyboard {
    last: Option<(Key, Instant)>,
}

impl Keyboard {
    /// Converts a terminal event to a key press, with the time since the same key last went down. `None` for releases
    /// and unknown keys; the press after an unknown key is treated as new.
    pub fn take(&mut self, event: &KeyEvent, now: Instant) -> Option<KeyPress> {
        let press = key_from_crossterm(event);
        let last = self.last.take();
        let press = press?;
        self.last = Some((press.key, now));
        let same = last.filter(|(key, _)| *key == press.key);
        Some(KeyPress { since_same: same.map(|(_, at)| now.saturating_duration_since(at)), ..press })
    }
}

/// The key of a terminal event; `None` for releases and unknown keys.
///
/// Alt is not used: over a slow connection it cannot be distinguished from Esc followed by a letter.
fn key_from_crossterm(event: &KeyEvent) -> Option<KeyPress> {
    let repeat = match event.kind {
        KeyEventKind::Press => false,
        KeyEventKind::Repeat => true,
        KeyEventKind::Release => return None,
    };
    let control = event.modifiers.contains(KeyModifiers::CONTROL);
    if event.modifiers.contains(KeyModifiers::ALT) {
        return None;
    }
    let key = match event.code {
        KeyCode::Char(letter) if control => Key::Ctrl(letter.to_ascii_lowercase()),
        KeyCode::Char(letter) => Key::Char(letter),
        KeyCode::F(number) => Key::F(number),
        KeyCode::Enter => Key::Enter,
        KeyCode::Esc => Key::Esc,
        KeyCode::Tab => Key::Tab,
        KeyCode::BackTab => Key::BackTab,
        KeyCode::Backspace => Key::Backspace,
        KeyCode::Delete => Key::Delete,
        KeyCode::Up => Key::Up,
        KeyCode::Down => Key::Down,
        KeyCode::Left if control => Key::CtrlLeft,
        KeyCode::Right if control => Key::CtrlRight,
        KeyCode::Left => Key::Left,
        KeyCode::Right => Key::Right,
        KeyCode::PageUp => Key::PageUp,
        KeyCode::PageDown => Key::PageDown,
        KeyCode::Home => Key::Home,
        KeyCode::End => Key::End,
        _ => return None,
    };
    Some(KeyPress { repeat, ..key.into() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::Freshness;
    use std::time::Duration;

    fn press(code: KeyCode, modifiers: KeyModifiers, kind: KeyEventKind) -> Option<KeyPress> {
        key_from_crossterm(&KeyEvent::new_with_kind(code, modifiers, kind))
    }

    #[test]
    fn releases_are_ignored_and_repeats_are_marked() {
        let space = |kind| press(KeyCode::Char(' '), KeyModifiers::NONE, kind);
        assert_eq!(space(KeyEventKind::Press), Some(Key::Char(' ').into()));
        assert_eq!(space(KeyEventKind::Repeat), Some(KeyPress { repeat: true, ..Key::Char(' ').into() }));
        assert_eq!(space(KeyEventKind::Release), None);
    }

    #[test]
    #[allow(clippy::disallowed_methods, reason = "any time will do")]
    fn a_press_knows_how_long_after_the_same_key_it_came() {
        let (mut keyboard, began) = (Keyboard::default(), Instant::now());
        let mut since = |letter, kind, at_ms| {
            let event = KeyEvent::new_with_kind(KeyCode::Char(letter), KeyModifiers::NONE, kind);
            let press = keyboard.take(&event, began + Duration::from_millis(at_ms));
            press.map(|press| (press.since_same.map(|passed| passed.as_millis()), press.freshness()))
        };
        let press = KeyEventKind::Press;
        assert_eq!(since('.', press, 0), Some((None, Freshness::Fresh)));
        assert_eq!(since('.', press, 500), Some((Some(500), Freshness::Unclear)));
        assert_eq!(since('.', press, 533), Some((Some(33), Freshness::Held)));
        assert_eq!(since('.', press, 3000), Some((Some(2467), Freshness::Fresh)));
        assert_eq!(since('x', press, 3010), Some((None, Freshness::Fresh)));
        assert_eq!(since('.', press, 3020), Some((None, Freshness::Fresh)));
        assert_eq!(since('.', KeyEventKind::Repeat, 9000), Some((Some(5980), Freshness::Held)));
        // A terminal that tells when the key comes up tells that the next press is one.
        assert_eq!(since('.', KeyEventKind::Release, 9010), None);
        assert_eq!(since('.', press, 9020), Some((None, Freshness::Fresh)));
    }

    #[test]
    fn capitals_keep_their_shift_and_control_is_recognized() {
        let press = |code, modifiers| press(code, modifiers, KeyEventKind::Press).map(|press| press.key);
        assert_eq!(press(KeyCode::Char('S'), KeyModifiers::SHIFT), Some(Key::Char('S')));
        assert_eq!(press(KeyCode::Char('c'), KeyModifiers::CONTROL), Some(Key::Ctrl('c')));
        assert_eq!(press(KeyCode::Char('s'), KeyModifiers::ALT), None);
    }
}
