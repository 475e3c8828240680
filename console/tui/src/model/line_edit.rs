//! An input line.

use crate::keys::Key;
use serde::{Deserialize, Serialize};

/// The longest text that can be typed, characters.
const MAX_TYPED: usize = 128;

/// An input line with its cursor.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct LineEdit {
    text: String,
    /// The cursor position: the number of bytes before the cursor.
    cursor: usize,
}

impl From<&str> for LineEdit {
    /// Creates a line with the given text and the cursor at the end.
    fn from(text: &str) -> Self {
        Self { text: text.to_owned(), cursor: text.len() }
    }
}

impl LineEdit {
    /// The typed text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The text before the cursor.
    pub fn before(&self) -> &str {
        &self.text[..self.cursor]
    }

    fn after(&self) -> &str {
        &self.text[self.cursor..]
    }

    /// Edits the line or moves the cursor; returns whether the key does either of these.
    pub fn press(&mut self, key: Key) -> bool {
        match key {
            Key::Char(letter) => self.insert(letter.encode_utf8(&mut [0; 4])),
            Key::Backspace => self.delete_from(self.step_left()),
            Key::Delete => self.delete_to(self.step_right()),
            Key::Ctrl('u') => self.delete_from(0),
            Key::Ctrl('w') => self.delete_from(self.word_left()),
            Key::Left => self.cursor = self.step_left(),
            Key::Right => self.cursor = self.step_right(),
            Key::CtrlLeft => self.cursor = self.word_left(),
            Key::CtrlRight => self.cursor = self.word_right(),
            Key::Home => self.cursor = 0,
            Key::End => self.cursor = self.text.len(),
            _ => return false,
        }
        true
    }

    /// Inserts as much text at the cursor as fits; control characters are left out.
    pub fn insert(&mut self, text: &str) {
        let room = MAX_TYPED.saturating_sub(self.text.chars().count());
        let text: String = text.chars().filter(|letter| !letter.is_control()).take(room).collect();
        self.text.insert_str(self.cursor, &text);
        self.cursor += text.len();
    }

    /// Replaces the word around the cursor, from its beginning at byte `begin` to the next space.
    pub fn replace_word(&mut self, begin: usize, with: &str) {
        let rest = self.after().find(' ').map_or("", |at| &self.after()[at..]);
        let front = format!("{}{with}", &self.text[..begin]);
        (self.text, self.cursor) = (format!("{front}{rest}"), front.len());
    }

    fn delete_from(&mut self, begin: usize) {
        self.text.replace_range(begin..self.cursor, "");
        self.cursor = begin;
    }

    fn delete_to(&mut self, end: usize) {
        self.text.replace_range(self.cursor..end, "");
    }

    fn step_left(&self) -> usize {
        self.before().char_indices().next_back().map_or(0, |(at, _)| at)
    }

    fn step_right(&self) -> usize {
        self.cursor + self.after().chars().next().map_or(0, char::len_utf8)
    }

    /// The beginning of the word at or before the cursor.
    fn word_left(&self) -> usize {
        let words = self.before().trim_end();
        words
            .char_indices()
            .rfind(|(_, letter)| letter.is_whitespace())
            .map_or(0, |(at, l)| at + l.len_utf8())
    }

    /// The end of the word at or after the cursor.
    fn word_right(&self) -> usize {
        let blank = self.after().len() - self.after().trim_start().len();
        let word = &self.after()[blank..];
        self.cursor + blank + word.find(char::is_whitespace).unwrap_or(word.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The line after these keys are pressed; `|` is the cursor.
    fn pressed(line: &str, keys: &[Key]) -> String {
        let mut edit = LineEdit { text: line.replace('|', ""), cursor: line.find('|').expect("a cursor") };
        for key in keys {
            assert!(edit.press(*key), "{key}");
        }
        format!("{}|{}", edit.before(), edit.after())
    }

    #[test]
    fn keys_edit_at_the_cursor() {
        let cases: [(&str, &[Key], &str); 14] = [
            ("ab|", &[Key::Char('c')], "abc|"),
            ("a|b", &[Key::Char(' ')], "a |b"),
            ("aé|b", &[Key::Backspace], "a|b"),
            ("a|éb", &[Key::Delete], "a|b"),
            ("|", &[Key::Backspace, Key::Delete, Key::Left, Key::Right], "|"),
            ("speed 8|", &[Key::Ctrl('w')], "speed |"),
            ("speed 8  |x", &[Key::Ctrl('w')], "speed |x"),
            ("speed| 8", &[Key::Ctrl('u')], "| 8"),
            ("a漢b|", &[Key::Left, Key::Left], "a|漢b"),
            ("set k=2|", &[Key::CtrlLeft], "set |k=2"),
            ("set |k=2", &[Key::CtrlLeft, Key::CtrlLeft], "|set k=2"),
            ("set| k=2 x", &[Key::CtrlRight], "set k=2| x"),
            ("a|b", &[Key::Home], "|ab"),
            ("a|b", &[Key::End], "ab|"),
        ];
        for (line, keys, expected) in cases {
            assert_eq!(pressed(line, keys), expected, "{keys:?} in {line}");
        }
    }

    #[test]
    fn other_keys_are_not_taken() {
        for key in [Key::Enter, Key::Esc, Key::Tab, Key::Up, Key::Ctrl('c'), Key::F(1)] {
            assert!(!LineEdit::default().press(key), "{key}");
        }
    }

    #[test]
    fn a_line_has_an_end_and_no_control_characters() {
        let mut edit = LineEdit::default();
        edit.insert(&"a\nb".repeat(100));
        assert_eq!(edit.text().len(), MAX_TYPED);
        assert!(edit.press(Key::Char('x')) && !edit.text().contains(['x', '\n']));
    }

    #[test]
    fn a_word_is_replaced_whole() {
        let mut edit = LineEdit { text: "open cov planner=apf".into(), cursor: 7 };
        edit.replace_word(5, "cover-circle");
        assert_eq!((edit.text(), edit.before()), ("open cover-circle planner=apf", "open cover-circle"));
    }
}
