//! Keys as the console names them, free of any terminal library.

use serde::{Deserialize, Serialize};
use std::{fmt, time::Duration};

/// One key, with its modifier where it has one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Key {
    /// A character as typed; capitals come as capitals.
    Char(char),
    /// A small letter with Ctrl.
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
    /// Arrow up.
    Up,
    /// Arrow down.
    Down,
    /// Arrow left.
    Left,
    /// Arrow right.
    Right,
    /// Arrow left with Ctrl.
    CtrlLeft,
    /// Arrow right with Ctrl.
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

/// A key going down, or repeating while it is held down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeyPress {
    /// Which key.
    pub key: Key,
    /// Whether the terminal says that it repeats; only movement listens to repeats.
    pub repeat: bool,
    /// How long after the same key, if no other went down between: many terminals do not say that a key repeats. `None` for a
    /// press that follows another key, and for one that no keyboard made.
    #[serde(default)]
    pub since_same: Option<Duration>,
}

/// What a press is, as far as it can be told by the time that has passed since the same key went down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Freshness {
    /// The key is held down.
    Held,
    /// The key is held down and repeats for the first time, or it was pressed again: what follows tells.
    Unclear,
    /// The key was pressed.
    Fresh,
}

impl KeyPress {
    /// A key that is held down repeats at least this often.
    pub const REPEATS_WITHIN: Duration = Duration::from_millis(300);
    /// A key that is held down repeats for the first time within this.
    const BEGINS_WITHIN: Duration = Duration::from_secs(2);

    /// Whether the key is held down.
    pub fn freshness(&self) -> Freshness {
        match self.since_same {
            _ if self.repeat => Freshness::Held,
            Some(passed) if passed < Self::REPEATS_WITHIN => Freshness::Held,
            Some(passed) if passed < Self::BEGINS_WITHIN => Freshness::Unclear,
            Some(_) | None => Freshness::Fresh,
        }
    }
}

/// Keys with a name of their own, as `keys.toml` writes them.
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
    /// The key of a name: a character, `space`, `enter`, `up`, `F5`, `Ctrl-L`.
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

    /// Its name, as `keys.toml` writes it.
    pub fn name(self) -> String {
        let named = NAMED.iter().find(|(_, key)| *key == self);
        named.map_or_else(|| self.to_string(), |(name, _)| (*name).to_owned())
    }
}

impl From<Key> for KeyPress {
    fn from(key: Key) -> Self {
        Self { key, repeat: false, since_same: None }
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
            other => write!(f, "{other:?}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
