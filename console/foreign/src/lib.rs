//! What is not ours: names, texts and files that other people and other programs wrote.
//!
//! One rule makes text plain ([`plain`] and its relatives), so that no name moves a cursor, turns the text around it, or hides in
//! it, wherever it goes. One rule names the encoding of a text that is not UTF-8 ([`NotUtf8`]). One rule opens files ([`open_regular`]), so that no pipe is waited for, no device is read without end, and
//! no file takes more memory than its kind may.

mod encoding;
mod file;
mod text;

pub use encoding::{NotUtf8, wide};
pub use file::{
    MOST_TEXT_BYTES, json_weight, open_regular, open_waiting, read_at_most, read_json, read_regular, text_of,
};
pub use text::{is_plain, plain, plain_json, plain_lines, seen, unplain};
