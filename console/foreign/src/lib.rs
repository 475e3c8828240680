//! Handles names, texts and files that other people and other programs wrote.
//!
//! [`plain`] and similar functions make a text plain: wherever a name is shown, it cannot move a cursor, reverse the
//! text around it, or hide in it. [`NotUtf8`] names the encoding of a text that is not UTF-8. [`open_regular`] opens
//! files; it never waits for a pipe, and refuses devices that never end. The functions that read files limit the memory
//! that a file can take.

mod encoding;
mod file;
mod text;

pub use encoding::{NotUtf8, wide};
pub use file::{
    MOST_TEXT_BYTES, json_weight, open_regular, open_waiting, read_at_most, read_json, read_regular, text_of,
};
pub use text::{is_plain, markup, plain, plain_json, plain_lines, seen, unplain};
