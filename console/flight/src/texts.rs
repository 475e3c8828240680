//! Reads short text files written by people: scripts, plans, facts, lists.

use crate::failure::bad_input;
use foreign::{MOST_TEXT_BYTES, open_waiting, text_of};
use std::{io, path::Path};

/// Reads a text file, which may be a pipe.
///
/// # Errors
/// The file cannot be read or is not UTF-8; the message states what the file contains instead and what to do.
pub fn read(file: &Path) -> anyhow::Result<String> {
    named(file, open_waiting(file).and_then(|open| text_of(open, MOST_TEXT_BYTES)))
}

/// Reads a regular text file.
///
/// # Errors
/// As for [`read`]; also if the file is not a regular file.
pub fn read_regular(file: &Path) -> anyhow::Result<String> {
    named(file, foreign::read_regular(file))
}

fn named(file: &Path, text: io::Result<String>) -> anyhow::Result<String> {
    text.map_err(|error| bad_input(format!("{}: {error}", file.display())))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn what_is_not_utf_8_is_named_with_its_remedy() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), b"# plan\nname = \"Gr\xfcn\"\n").unwrap();
        for read in [read, read_regular] {
            let error = read(file.path()).unwrap_err().to_string();
            assert!(
                error.contains(": ISO-8859-1 instead of UTF-8, judging by line 2; save it as UTF-8: `iconv"),
                "{error}"
            );
        }
        std::fs::write(file.path(), "name = \"Grün\"\n").unwrap();
        assert_eq!(read(file.path()).unwrap(), "name = \"Grün\"\n");
    }
}
