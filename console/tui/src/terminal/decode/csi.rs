//! Control sequences: keys, mouse reports and short answers.

use super::{Gesture, Input, Pointed};
use crate::keys::{Key, KeyPress};

/// Maximum number of bytes kept of a sequence; no key needs more.
const KEPT: usize = 32;
/// The bits of the modifiers, one less than the number that the terminal sends.
const ALT: u32 = 2;
const CONTROL: u32 = 4;

/// The bytes of a sequence before its final byte.
#[derive(Debug, Default)]
pub(super) struct Csi {
    kept: Vec<u8>,
    is_too_long: bool,
}

/// The terminal's report about a key, apart from its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct How {
    modifiers: u32,
    is_repeat: bool,
    is_release: bool,
}

impl Csi {
    pub(super) fn take(&mut self, byte: u8) {
        self.is_too_long |= self.kept.len() >= KEPT;
        if !self.is_too_long {
            self.kept.push(byte);
        }
    }

    #[cfg(test)]
    pub(super) fn kept(&self) -> usize {
        self.kept.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.kept.is_empty()
    }

    pub(super) fn is(&self, bytes: &[u8]) -> bool {
        self.kept == bytes && !self.is_too_long
    }

    /// The meaning of the sequence with its final byte; `None` for an answer, a focus report and other sequences that
    /// are not keys.
    pub(super) fn input(&self, last: u8) -> Option<Input> {
        let text = std::str::from_utf8(&self.kept).ok().filter(|_| !self.is_too_long)?;
        if let Some(report) = text.strip_prefix('<') {
            return mouse(report, last).map(Input::Mouse);
        }
        if last == b'c' && text.starts_with('?') {
            return Some(Input::Kind);
        }
        if !text.bytes().all(|byte| byte.is_ascii_digit() || matches!(byte, b';' | b':')) {
            return None;
        }
        let field = |at: usize| text.split(';').nth(at).unwrap_or_default();
        let number = |field: &str| field.split(':').next().and_then(|digits| digits.parse::<u32>().ok());
        let (key, how) = match last {
            b'~' if field(0) == "27" => (character(number(field(2))?), How::of(field(1))),
            b'~' => (numbered(number(field(0))?), How::of(field(1))),
            b'u' => (character(number(field(0))?), How::of(field(1))),
            // With numbers, R ends a report of the cursor position.
            b'R' if !text.is_empty() => return None,
            b'A'..=b'D' | b'F' | b'H' | b'P'..=b'S' | b'Z' => (ss3(last), How::of(field(1))),
            _ => return None,
        };
        Some(key.and_then(|key| how.press(key)).map_or(Input::OtherKey, Input::Key))
    }
}

impl How {
    /// Reads modifiers and the kind of the report, such as `5` or `1:3`.
    fn of(field: &str) -> Self {
        let (modifiers, event) = field.split_once(':').unwrap_or((field, ""));
        let modifiers = modifiers.parse::<u32>().map_or(0, |number| number.saturating_sub(1));
        Self { modifiers, is_repeat: event == "2", is_release: event == "3" }
    }

    fn press(self, key: Key) -> Option<KeyPress> {
        if self.is_release || self.modifiers & ALT != 0 {
            return None;
        }
        let key = match key {
            Key::Left if self.modifiers & CONTROL != 0 => Key::CtrlLeft,
            Key::Right if self.modifiers & CONTROL != 0 => Key::CtrlRight,
            Key::Char(letter) if self.modifiers & CONTROL != 0 => Key::Ctrl(letter.to_ascii_lowercase()),
            key => key,
        };
        Some(KeyPress { repeat: self.is_repeat, ..key.into() })
    }
}

/// The key of a letter after Esc O or Esc [.
pub(super) fn ss3(last: u8) -> Option<Key> {
    Some(match last {
        b'A' => Key::Up,
        b'B' => Key::Down,
        b'C' => Key::Right,
        b'D' => Key::Left,
        b'F' => Key::End,
        b'H' => Key::Home,
        b'M' => Key::Enter,
        b'Z' => Key::BackTab,
        b'P'..=b'S' => Key::F(last - b'P' + 1),
        _ => return None,
    })
}

/// The key of a letter after Esc [ [.
pub(super) fn linux_function(last: u8) -> Option<Key> {
    matches!(last, b'A'..=b'E').then(|| Key::F(last - b'A' + 1))
}

/// The key of a number before a tilde.
fn numbered(number: u32) -> Option<Key> {
    Some(match number {
        1 | 7 => Key::Home,
        3 => Key::Delete,
        4 | 8 => Key::End,
        5 => Key::PageUp,
        6 => Key::PageDown,
        11..=15 => Key::F((number - 10) as u8),
        17..=21 => Key::F((number - 11) as u8),
        23..=24 => Key::F((number - 12) as u8),
        _ => return None,
    })
}

/// The key of a character's number.
fn character(number: u32) -> Option<Key> {
    Some(match number {
        9 => Key::Tab,
        13 => Key::Enter,
        27 => Key::Esc,
        127 => Key::Backspace,
        number => Key::Char(char::from_u32(number).filter(|letter| !letter.is_control())?),
    })
}

/// Reads button, column and row, such as `0;12;7`.
fn mouse(report: &str, last: u8) -> Option<Pointed> {
    let mut numbers = report.split(';').map(|digits| digits.parse::<u16>().ok());
    let (button, column, row) = (numbers.next()??, numbers.next()??, numbers.next()??);
    let (is_down, is_moving, is_wheel) = (last == b'M', button & 32 != 0, button & 64 != 0);
    let gesture = match button & 3 {
        way @ 0..=1 if is_wheel && is_down => Gesture::Wheel { up: way == 0 },
        0 if !is_wheel && is_down && is_moving => Gesture::Drag,
        0 if !is_wheel && is_down => Gesture::Down,
        0 if !is_wheel && last == b'm' => Gesture::Up,
        _ => return None,
    };
    Some(Pointed { column: column.checked_sub(1)?, row: row.checked_sub(1)?, gesture })
}
