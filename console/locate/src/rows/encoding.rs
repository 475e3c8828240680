//! Detects the encoding of a file that is not UTF-8, and suggests what to do about it.

use foreign::{NotUtf8, open_regular};
use std::{
    io::{BufRead, BufReader, Read},
    path::Path,
};

/// The number of bytes examined at the start of a file.
const BEGINNING: u64 = 64;
/// The longest line that is read, bytes.
const LONGEST_LINE: u64 = 1 << 16;

/// Returns the problem with a file that has two or four bytes per character; `None` for any other file.
pub(super) fn wide(file: &Path) -> Option<String> {
    let mut beginning = Vec::new();
    open_regular(file).ok()?.take(BEGINNING).read_to_end(&mut beginning).ok()?;
    let name = NotUtf8::of(&beginning)?.encoding.filter(|name| name.starts_with("UTF"))?;
    Some(format!("line 1: text in {name} (\"Unicode text\" in spreadsheets); {}", remedy(name)))
}

/// Returns the problem with a line that is not UTF-8; the problem names the first invalid byte.
pub(super) fn narrow(file: &Path, line: u64) -> String {
    let bytes = bytes_of(file, line).unwrap_or_default();
    let byte = std::str::from_utf8(&bytes).err().and_then(|error| bytes.get(error.valid_up_to()));
    let shown = match byte {
        Some(byte @ 0xa0..) => format!("byte {byte:#04x} (`{}` in Windows-1252)", char::from(*byte)),
        Some(byte) => format!("byte {byte:#04x}"),
        None => "a byte".into(),
    };
    format!("{shown} is not UTF-8; {}", remedy("WINDOWS-1252"))
}

fn remedy(name: &str) -> String {
    format!("save the readings as \"CSV UTF-8\", or convert them: iconv -f {name} -t UTF-8 READINGS")
}

/// Returns the bytes of a line.
fn bytes_of(file: &Path, line: u64) -> Option<Vec<u8>> {
    let mut text = BufReader::new(open_regular(file).ok()?);
    let mut bytes = Vec::new();
    for _ in 0..line {
        bytes.clear();
        if text.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut bytes).ok()? == 0 {
            return None;
        }
    }
    Some(bytes)
}
