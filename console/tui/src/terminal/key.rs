//! Keys from the terminal library into the console's own.

use crate::keys::{Key, KeyPress};
use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

/// The key of a terminal event; `None` for releases and for keys that the console does not know.
///
/// Alt is not used: over a slow connection it cannot be distinguished from Esc followed by a letter.
pub fn key_from_crossterm(event: &KeyEvent) -> Option<KeyPress> {
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
    Some(KeyPress { key, repeat })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn press(code: KeyCode, modifiers: KeyModifiers, kind: KeyEventKind) -> Option<KeyPress> {
        key_from_crossterm(&KeyEvent::new_with_kind(code, modifiers, kind))
    }

    #[test]
    fn releases_are_ignored_and_repeats_are_marked() {
        let space = |kind| press(KeyCode::Char(' '), KeyModifiers::NONE, kind);
        assert_eq!(space(KeyEventKind::Press), Some(Key::Char(' ').into()));
        assert_eq!(space(KeyEventKind::Repeat), Some(KeyPress { key: Key::Char(' '), repeat: true }));
        assert_eq!(space(KeyEventKind::Release), None);
    }

    #[test]
    fn capitals_keep_their_shift_and_control_is_recognized() {
        let press = |code, modifiers| press(code, modifiers, KeyEventKind::Press).map(|press| press.key);
        assert_eq!(press(KeyCode::Char('S'), KeyModifiers::SHIFT), Some(Key::Char('S')));
        assert_eq!(press(KeyCode::Char('c'), KeyModifiers::CONTROL), Some(Key::Ctrl('c')));
        assert_eq!(press(KeyCode::Char('s'), KeyModifiers::ALT), None);
    }
}
