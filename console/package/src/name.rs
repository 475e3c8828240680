//! Names of entries.

/// The longest name, bytes.
const MOST_LETTERS: usize = 240;

/// Whether an entry may have this name: a relative path of plain letters, digits, `.`, `_`, `-` and `/` that stays in the
/// folder in which it is unpacked, on any system.
///
/// ```
/// assert!(package::is_name("readings/20261124T101500Z-a-1.parquet"));
/// for name in ["", "/etc/passwd", "../a", "a/../../b", "a//b", "C:a", "a\\b", "a/", "-a/.", "con\u{202e}"] {
///     assert!(!package::is_name(name), "{name}");
/// }
/// ```
pub fn is_name(name: &str) -> bool {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"._-/".contains(&byte);
    let is_part = |part: &str| !part.is_empty() && part.bytes().any(|byte| byte != b'.');
    name.len() <= MOST_LETTERS && name.bytes().all(is_plain) && name.split('/').all(is_part)
}
