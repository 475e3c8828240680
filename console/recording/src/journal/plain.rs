//! Cleans the texts in journal lines. Every reader except the line comparison receives plain text, so that neither
//! hidden nor control characters reach a screen or a file.

use foreign::is_plain;

/// The replacement for a character that is not plain, in JSON.
const INSTEAD: &str = "\\ufffd";

/// The line with `\ufffd` in place of each character that is not plain, literal or escaped; `None` if the line is
/// already plain. Line breaks and tabs within texts are kept.
pub(super) fn line(line: &[u8]) -> Option<Vec<u8>> {
    if line.iter().all(|byte| matches!(byte, b' '..=b'[' | b']'..=b'~' | b'\n')) {
        return None;
    }
    // The JSON reader refuses a line that is not UTF-8.
    let text = std::str::from_utf8(line).ok()?;
    let (mut plain, mut rest, mut is_changed) = (String::with_capacity(text.len()), text, false);
    while let Some((c, length)) = next(rest) {
        let is_kept = c.is_none_or(|c| is_plain(c) || matches!(c, '\n' | '\t' | '\r'));
        plain.push_str(if is_kept { &rest[..length] } else { INSTEAD });
        is_changed |= !is_kept;
        rest = &rest[length..];
    }
    is_changed.then(|| plain.into_bytes())
}

/// The next character of a JSON text, and its length as written; no character for an invalid escape.
fn next(text: &str) -> Option<(Option<char>, usize)> {
    let first = text.chars().next()?;
    if first != '\\' {
        return Some((Some(first), first.len_utf8()));
    }
    let second = text[1..].chars().next();
    let length = 1 + second.map_or(0, char::len_utf8);
    Some(match second {
        Some('b') => (Some('\u{8}'), length),
        Some('f') => (Some('\u{c}'), length),
        Some('u') => escaped(text),
        // The escape of a quote, a slash or a line break: it is plain.
        _ => (None, length),
    })
}

/// The character of an escape such as `\u20ac`, or of a surrogate pair of two escapes.
fn escaped(text: &str) -> (Option<char>, usize) {
    let unit = |at: usize| -> Option<u16> {
        let digits = text.get(at..at + 6)?.strip_prefix("\\u")?;
        u16::from_str_radix(digits, 16).ok()
    };
    let Some(first) = unit(0) else { return (None, 2) };
    let pair = unit(6).and_then(|second| char::decode_utf16([first, second]).next()?.ok());
    match (char::from_u32(u32::from(first)), pair) {
        (Some(alone), _) => (Some(alone), 6),
        (None, Some(pair)) => (Some(pair), 12),
        // Half of a surrogate pair.
        (None, None) => (None, 6),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use serde_json::{Value, json};

    #[test]
    fn texts_are_plain_however_they_were_written() {
        let hostile = "a\u{1b}b\u{9b}c\u{202e}d\u{e0001}e\u{ad}f\u{8}g";
        let written = serde_json::to_string(&json!({ "name": hostile })).unwrap();
        let escaped = r#"{"name":"a\u001bb\u009bc\u202ed\udb40\udc01e\u00ADf\bg"}"#;
        for text in [written.as_str(), escaped] {
            let read: Value = serde_json::from_slice(&line(text.as_bytes()).unwrap()).unwrap();
            assert_eq!(read["name"], "a�b�c�d�e�f�g", "{text}");
        }
    }

    #[test]
    fn plain_lines_stay_as_they_are() {
        for text in
            [r#"{"a":"one\ntwo\tthree\r\n \"q\" \\u001b \/ Sä\u00fcle 漢"}"#, "{}", r#"{"a":"\ud83d\ude00"}"#]
        {
            assert_eq!(line(text.as_bytes()), None, "{text}");
        }
        for broken in [&b"{\"a\":\"\\"[..], b"\\u12", b"\\ud800", b"\xff\\u001b"] {
            assert_eq!(line(broken), None);
        }
    }
}
