//! Which encoding a file is in that is not in UTF-8, and what to do about it.

use recording::open_regular;
use std::{
    io::{BufRead, BufReader, Read},
    path::Path,
};

/// Bytes of a beginning that are looked at.
const BEGINNING: u64 = 64;
/// A line with more bytes than this is none.
const LONGEST_LINE: u64 = 1 << 16;

/// What is wrong with a file of two bytes a character; `None` if it is no such file.
pub(super) fn wide(file: &Path) -> Option<String> {
    let mut beginning = Vec::new();
    open_regular(file).ok()?.take(BEGINNING).read_to_end(&mut beginning).ok()?;
    let zeros = |from: usize| beginning.iter().skip(from).step_by(2).filter(|byte| **byte == 0).count();
    let half = beginning.len() / 2;
    let name = match beginning.as_slice() {
        [0xff, 0xfe, ..] => "UTF-16LE",
        [0xfe, 0xff, ..] => "UTF-16BE",
        // Latin letters in pairs of bytes without a mark.
        _ if half > 4 && zeros(1) == half && zeros(0) == 0 => "UTF-16LE",
        _ if half > 4 && zeros(0) >= half && zeros(1) == 0 => "UTF-16BE",
        _ => return None,
    };
    Some(format!(
        "line 1: text in {name} (\"Unicode text\" of spreadsheets); save the readings as \"CSV UTF-8\", or convert them: iconv -f \
         {name} -t UTF-8 READINGS"
    ))
}

/// What is wrong with the line of a file that is no UTF-8, by the first such byte in it.
pub(super) fn narrow(file: &Path, line: u64) -> String {
    let byte = first_byte(file, line);
    let shown = match byte {
        Some(byte @ 0xa0..) => format!("byte {byte:#04x} (`{}` in Windows-1252)", char::from(byte)),
        Some(byte) => format!("byte {byte:#04x}"),
        None => "a byte".into(),
    };
    format!(
        "{shown} is no UTF-8, as in text in Windows-1252 (ISO 8859-1); save the readings as \"CSV UTF-8\", or convert them: iconv -f \
         WINDOWS-1252 -t UTF-8 READINGS"
    )
}

/// The first byte of a line that is no UTF-8.
fn first_byte(file: &Path, line: u64) -> Option<u8> {
    let mut text = BufReader::new(open_regular(file).ok()?);
    let mut bytes = Vec::new();
    for _ in 0..line {
        bytes.clear();
        if text.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut bytes).ok()? == 0 {
            return None;
        }
    }
    let error = std::str::from_utf8(&bytes).err()?;
    bytes.get(error.valid_up_to()).copied()
}
