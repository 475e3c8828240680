//! Short texts that people write: scripts, plans, facts, lists.

use crate::failure::bad_input;
use foreign::{MOST_TEXT_BYTES, open_regular};
use scenario::Foreign;
use std::{
    fs::File,
    io::{self, Read},
    path::Path,
};

/// The text of a file, which may be a pipe.
///
/// # Errors
/// It cannot be read or is not UTF-8: what it is instead, and what to do about it.
pub fn read(file: &Path) -> anyhow::Result<String> {
    text(file, File::open(file).and_then(all))
}

/// The text of a regular file.
///
/// # Errors
/// As [`read`]; also that it is no regular file.
pub fn read_regular(file: &Path) -> anyhow::Result<String> {
    text(file, open_regular(file).and_then(all))
}

/// All of a file that is not too long for a text that somebody wrote.
fn all(file: File) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.take(MOST_TEXT_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_TEXT_BYTES {
        return Err(io::Error::new(
            io::ErrorKind::InvalidData,
            format!("it is longer than {} MB", MOST_TEXT_BYTES >> 20),
        ));
    }
    Ok(bytes)
}

fn text(file: &Path, bytes: io::Result<Vec<u8>>) -> anyhow::Result<String> {
    let shown = file.display();
    let bytes = bytes.map_err(|error| bad_input(format!("{shown}: {error}")))?;
    match Foreign::of(&bytes) {
        Some(foreign) => Err(bad_input(format!("{shown}: {foreign}; {}", foreign.remedy()))),
        None => Ok(String::from_utf8_lossy(&bytes).into_owned()),
    }
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
                error.contains(": not UTF-8 but ISO-8859-1, by line 2; save it as UTF-8: `iconv"),
                "{error}"
            );
        }
        std::fs::write(file.path(), "name = \"Grün\"\n").unwrap();
        assert_eq!(read(file.path()).unwrap(), "name = \"Grün\"\n");
    }
}
