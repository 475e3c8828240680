//! An input line, with the terminal's cursor.

use super::text;
use crate::model::LineEdit;

/// The visible part of an input line.
pub(super) struct Field {
    /// The text from the first visible character on.
    pub text: String,
    /// The column of the cursor within the text.
    pub cursor: usize,
    /// The number of bytes of the line before the text.
    pub skipped: usize,
}

/// The part of a line around its cursor that fits into a given width.
pub(super) fn field(line: &LineEdit, columns: usize) -> Field {
    let before = line.before();
    let fits = |begin: usize| text::width(&before[begin..]) < columns.max(1);
    let begins = before.char_indices().map(|(at, _)| at).chain([before.len()]);
    let skipped = begins.into_iter().find(|begin| fits(*begin)).unwrap_or(before.len());
    Field {
        text: text::fit(&line.text()[skipped..], columns),
        cursor: text::width(&before[skipped..]),
        skipped,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::Key;

    #[test]
    fn a_long_line_is_shown_around_its_cursor() {
        let mut line = LineEdit::from("abcdefgh");
        let shown = |line: &LineEdit| {
            let field = field(line, 4);
            (field.text, field.cursor, field.skipped)
        };
        assert_eq!(shown(&line), ("fgh".into(), 3, 5));
        line.press(Key::Home);
        assert_eq!(shown(&line), ("abc…".into(), 0, 0));
        assert_eq!(field(&"漢字".into(), 4).text, "字");
    }
}
