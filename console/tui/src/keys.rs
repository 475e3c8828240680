//! Keys as the console names them, independent of any terminal library.

use serde::{Deserialize, Serialize};
use std::{fmt, time::Duration};

/// A key, with its modifier if it has one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(strum::EnumCount))]
pub enum Key {
    /// A character as typed; capitals arrive as capitals.
    Char(char),
    /// A lower-case letter with Ctrl.
    Ctrl(char),
    /// A function key.
    F(u8),
    /// Enter.
    Enter,
    /// Escape.
    Esc,
    /// Tab.
    Tab,
    /// Shift and Tab.
    BackTab,
    /// Backspace.
    Backspace,
    /// Delete.
    Delete,
    /// Up arrow.
    Up,
    /// Down arrow.
    Down,
    /// Left arrow.
    Left,
    /// Right arrow.
    Right,
    /// Left arrow with Ctrl.
    CtrlLeft,
    /// Right arrow with Ctrl.
    CtrlRight,
    /// Page up.
    PageUp,
    /// Page down.
    PageDown,
    /// Home.
    Home,
    /// End.
    End,
}

/// A key press, or a repeat while the key is held down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeyPress {
    /// The key.
    pub key: Key,
    /// Whether the terminal reports the press as a repeat; only movement actions act on repeats.
    pub repeat: bool,
    /// The time since the same key last went down, if no other key was pressed in between; it is needed because many
    /// terminals do not report key repeats. `None` for a press that follows a different key, and for one that did not
    /// come from a keyboard.
    #[serde(default)]
    pub since_same: Option<Duration>,
    /// The number of the last frame drawn before the key was read: only a question in that frame can be answered.
    /// `None` for a press that did not come from a keyboard.
    #[serde(default)]
    pub seen: Option<u64>,
}

/// The kind of a key press, judged by the time since the last press of the same key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Freshness {
    /// The key is held down.
    Held,
    /// Either the first repeat of a key that is held down, or a second press; only the next press can show which.
    Unclear,
    /// The key was pressed.
    Fresh,
}

impl KeyPress {
    /// A key pressed again within this time is being held down.
    pub const REPEATS_WITHIN: Duration = Duration::from_millis(300);
    /// A key that is held down starts to repeat within this time.
    const BEGINS_WITHIN: Duration = Duration::from_secs(2);

    /// Classifies the press by the time since the last press of the same key.
    pub fn freshness(&self) -> Freshness {
        match self.since_same {
            _ if self.repeat => Freshness::Held,
            Some(passed) if passed < Self::REPEATS_WITHIN => Freshness::Held,
            Some(passed) if passed < Self::BEGINS_WITHIN => Freshness::Unclear,
            Some(_) | None => Freshness::Fresh,
        }
    }
}

/// Keys that have names in `keys.toml`.
const NAMED: [(&str, Key); 17] = [
    ("space", Key::Char(' ')),
    ("enter", Key::Enter),
    ("esc", Key::Esc),
    ("tab", Key::Tab),
    ("shift-tab", Key::BackTab),
    ("backspace", Key::Backspace),
    ("delete", Key::Delete),
    ("up", Key::Up),
    ("down", Key::Down),
    ("left", Key::Left),
    ("right", Key::Right),
    ("ctrl-left", Key::CtrlLeft),
    ("ctrl-right", Key::CtrlRight),
    ("pgup", Key::PageUp),
    ("pgdn", Key::PageDown),
    ("home", Key::Home),
    ("end", Key::End),
];

impl Key {
    /// The key with a given name: a character, `space`, `enter`, `up`, `F5`, `Ctrl-L`.
    pub fn named(name: &str) -> Option<Self> {
        let mut letters = name.chars();
        if let (Some(letter), None) = (letters.next(), letters.next()) {
            return (!letter.is_control() && letter != ' ').then_some(Self::Char(letter));
        }
        let small = name.to_ascii_lowercase();
        let control = || match small.strip_prefix("ctrl-")?.as_bytes() {
            [letter @ b'a'..=b'z'] => Some(Self::Ctrl(char::from(*letter))),
            _ => None,
        };
        let function = || {
            let number = small.strip_prefix('f')?.parse().ok().filter(|number| (1..=12).contains(number))?;
            Some(Self::F(number))
        };
        let named = NAMED.iter().find(|(known, _)| *known == small).map(|(_, key)| *key);
        named.or_else(control).or_else(function)
    }

    /// The key's name, as `keys.toml` writes it.
    pub fn name(self) -> String {
        let named = NAMED.iter().find(|(_, key)| *key == self);
        named.map_or_else(|| self.to_string(), |(name, _)| (*name).to_owned())
    }
}

impl From<Key> for KeyPress {
    fn from(key: Key) -> Self {
        Self { key, repeat: false, since_same: None, seen: None }
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Char(' ') => f.write_str("space"),
            Self::Char(c) => write!(f, "{c}"),
            Self::Ctrl(c) => write!(f, "Ctrl-{}", c.to_ascii_uppercase()),
            Self::F(number) => write!(f, "F{number}"),
            Self::Up => f.write_str("↑"),
            Self::Down => f.write_str("↓"),
            Self::Left => f.write_str("←"),
            Self::Right => f.write_str("→"),
            Self::CtrlLeft => f.write_str("Ctrl-←"),
            Self::CtrlRight => f.write_str("Ctrl-→"),
            Self::PageUp => f.write_str("PgUp"),
            Self::PageDown => f.write_str("PgDn"),
            Self::BackTab => f.write_str("Shift-Tab"),
            Self::Enter => f.write_str("Enter"),
            Self::Esc => f.write_str("Esc"),
            Self::Tab => f.write_str("Tab"),
            Self::Backspace => f.write_str("Backspace"),
            Self::Delete => f.write_str("Delete"),
            Self::Home => f.write_str("Home"),
            Self::End => f.write_str("End"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use strum::EnumCount;

    #[test]
    fn every_key_is_found_by_its_name() {
        let keys = NAMED.map(|(_, key)| key).into_iter().chain([
            Key::Char('S'),
            Key::Char('é'),
            Key::Ctrl('l'),
            Key::F(1),
            Key::F(12),
        ]);
        for key in keys {
            assert_eq!(Key::named(&key.name()), Some(key), "{key}");
        }
        for wrong in ["", " ", "F13", "F0", "Ctrl-", "Ctrl-é", "hyper", "ss"] {
            assert_eq!(Key::named(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn keys_are_written_as_the_keyboard_has_them() {
        let shown: Vec<String> = [Key::Char(' '), Key::Char('S'), Key::Ctrl('c'), Key::F(1), Key::Enter]
            .map(|key| key.to_string())
            .into();
        assert_eq!(shown, ["space", "S", "Ctrl-C", "F1", "Enter"]);
    }

    #[test]
    fn every_key_has_a_word_of_its_own() {
        let all: [Key; Key::COUNT] = [
            Key::Char('s'),
            Key::Ctrl('s'),
            Key::F(1),
            Key::Enter,
            Key::Esc,
            Key::Tab,
            Key::BackTab,
            Key::Backspace,
            Key::Delete,
            Key::Up,
            Key::Down,
            Key::Left,
            Key::Right,
            Key::CtrlLeft,
            Key::CtrlRight,
            Key::PageUp,
            Key::PageDown,
            Key::Home,
            Key::End,
        ];
        let words: BTreeSet<String> = all.iter().map(ToString::to_string).collect();
        assert_eq!(words.len(), all.len(), "{words:?}");
        assert!(words.iter().all(|word| !word.is_empty() && !word.contains('_')), "{words:?}");
    }
}
