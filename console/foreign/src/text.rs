//! Makes text plain.

use std::{borrow::Cow, fmt::Write};

/// Replaces a character that is not plain.
const INSTEAD: char = '\u{fffd}';

/// Whether a character is visible or a space, and so cannot move a cursor, reverse text, or hide.
///
/// The following are not plain: control characters (C0, DEL, C1), direction marks, characters without width or glyph
/// (soft hyphen, joiners, fillers, variation selectors, byte order mark), line and paragraph separators, tags, and
/// code points that are not characters.
pub fn is_plain(c: char) -> bool {
    let is_hidden = matches!(
        c,
        '\u{ad}'
            | '\u{34f}'
            | '\u{61c}'
            | '\u{115f}'..='\u{1160}'
            | '\u{17b4}'..='\u{17b5}'
            | '\u{180b}'..='\u{180f}'
            | '\u{200b}'..='\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{3164}'
            | '\u{fe00}'..='\u{fe0f}'
            | '\u{feff}'
            | '\u{ffa0}'
            | '\u{fff0}'..='\u{fffb}'
            | '\u{1bca0}'..='\u{1bca3}'
            | '\u{1d173}'..='\u{1d17a}'
            | '\u{e0000}'..='\u{e0fff}'
    );
    let is_none = matches!(u32::from(c) & 0xffff, 0xfffe | 0xffff) || matches!(c, '\u{fdd0}'..='\u{fdef}');
    !c.is_control() && !is_hidden && !is_none
}

/// Returns the first character of a text that is not plain, in the form `U+202E`. Line ends and tabs count as plain.
pub fn unplain(text: &str) -> Option<String> {
    let is_end = |at: usize| text[at..].starts_with("\r\n");
    let is_odd = |(at, c): &(usize, char)| !is_plain(*c) && !matches!(c, '\n' | '\t') && !is_end(*at);
    let found = text.char_indices().find(is_odd).map(|(_, c)| c);
    found.map(|c| format!("U+{:04X}", u32::from(c)))
}

/// Returns a text on one line: line ends and tabs become spaces, all other characters that are not plain become `�`.
pub fn plain(text: &str) -> Cow<'_, str> {
    let is_end = |c| matches!(c, '\t'..='\r' | '\u{85}' | '\u{2028}' | '\u{2029}');
    replaced(text, |c| if is_end(c) { ' ' } else { INSTEAD })
}

/// Returns a name from another program without its invisible characters, such as soft hyphens and joiners. Line ends
/// and tabs become spaces.
pub fn seen(name: &str) -> String {
    plain(name)
        .chars()
        .zip(name.chars())
        .filter(|(c, written)| *c != INSTEAD || *written == INSTEAD)
        .map(|(c, _)| c)
        .collect()
}

/// Returns a text of several lines: line feeds and tabs stay, all other characters that are not plain become `�`.
pub fn plain_lines(text: &str) -> Cow<'_, str> {
    let instead = |c| if matches!(c, '\n' | '\t') { c } else { INSTEAD };
    if text.contains("\r\n") {
        replaced(&text.replace("\r\n", "\n"), instead).into_owned().into()
    } else {
        replaced(text, instead)
    }
}

/// Returns a text for use as content or as an attribute value in XML and HTML: plain, with line feeds and tabs kept and
/// markup escaped.
///
/// ```
/// assert_eq!(foreign::markup("S1 <\"5 m\">"), "S1 &lt;&quot;5 m&quot;&gt;");
/// ```
pub fn markup(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in plain_lines(text).chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            c => escaped.push(c),
        }
    }
    escaped
}

fn replaced(text: &str, instead: impl Fn(char) -> char) -> Cow<'_, str> {
    rewritten(text, is_plain, |plain, c| plain.push(instead(c)))
}

/// Keeps the characters for which `may_stay` is true, and calls `write` to replace each of the rest.
fn rewritten(
    text: &str,
    may_stay: impl Fn(char) -> bool,
    mut write: impl FnMut(&mut String, char),
) -> Cow<'_, str> {
    if text.chars().all(&may_stay) {
        return text.into();
    }
    let mut plain = String::with_capacity(text.len() + 64);
    for c in text.chars() {
        if may_stay(c) {
            plain.push(c);
        } else {
            write(&mut plain, c);
        }
    }
    plain.into()
}

/// Returns JSON with the same values in which every character is plain: other characters are escaped, as in `\u202e`.
///
/// Line feeds and tabs are kept: in JSON they occur only as white space between values.
pub fn plain_json(text: &str) -> Cow<'_, str> {
    let may_stay = |c: char| is_plain(c) || matches!(c, '\n' | '\t');
    rewritten(text, may_stay, |plain, c| {
        for unit in c.encode_utf16(&mut [0; 2]) {
            let _ = write!(plain, "\\u{unit:04x}");
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// One character of each kind that is not plain.
    const HIDDEN: &str = "\u{0}\u{7}\u{8}\u{1b}\u{7f}\u{90}\u{9b}\u{9d}\u{ad}\u{61c}\u{115f}\u{180e}\u{200b}\u{200d}\u{200f}\u{202a}\u{202e}\
                          \u{2060}\u{2066}\u{2069}\u{206a}\u{3164}\u{fe0f}\u{feff}\u{fff9}\u{fffe}\u{e0001}\u{e0041}\u{e007f}\u{e0100}";

    #[test]
    fn what_hides_or_controls_is_shown_instead() {
        assert!(HIDDEN.chars().all(|c| !is_plain(c)));
        assert!(
            plain(HIDDEN).chars().all(|c| c == INSTEAD) && plain_lines(HIDDEN).chars().all(|c| c == INSTEAD)
        );
        assert_eq!(plain("a\u{202e}b\u{9b}2Jc"), "a�b�2Jc");
        assert_eq!(plain("one\ntwo\tthree\u{2028}four\u{85}five"), "one two three four five");
        assert_eq!(plain_lines("one\n\ttwo\r\n\r"), "one\n\ttwo\n�");
        assert_eq!((unplain("a\r\n\tb"), unplain("a\rb")), (None, Some("U+000D".into())));
        assert_eq!(unplain("a\u{ad}b"), Some("U+00AD".into()));
    }

    #[test]
    fn ordinary_names_stay_as_they_are() {
        for name in [
            "Säule 3",
            "u\u{308}ber",
            "Behälter\u{a0}7",
            "P-07",
            "タンク",
            "резервуар",
            "Ø 25 °C",
            "�",
            "⚠ 🛢",
        ] {
            assert!(matches!(plain(name), Cow::Borrowed(same) if same == name), "{name:?}");
        }
    }

    #[test]
    fn what_cannot_be_seen_is_no_part_of_a_name() {
        assert_eq!(seen("Pumpen\u{ad}sumpf\u{200b} 1\u{fe0f}\tNord\u{a0}"), "Pumpensumpf 1 Nord\u{a0}");
        assert_eq!(seen("\u{1b}[2J�"), "[2J�");
    }

    #[test]
    fn json_has_the_same_values_in_plain_characters() {
        let value = serde_json::json!({ "name": HIDDEN, "list": ["a\u{9b}b", "c"] });
        for text in [
            serde_json::to_string(&value).expect("JSON"),
            serde_json::to_string_pretty(&value).expect("JSON"),
        ] {
            let plain = plain_json(&text);
            assert_eq!(unplain(&plain), None);
            assert_eq!(serde_json::from_str::<serde_json::Value>(&plain).expect("JSON"), value);
        }
    }

    proptest! {
        #[test]
        fn every_text_becomes_plain_and_stays_so(text in any::<String>()) {
            let once = plain(&text);
            prop_assert!(once.chars().all(is_plain));
            prop_assert_eq!(plain(&once), once.as_ref());
            prop_assert_eq!(once.chars().count(), text.chars().count());
            prop_assert_eq!(unplain(&plain_lines(&text)), None);
        }
    }
}
