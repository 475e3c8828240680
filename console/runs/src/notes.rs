//! Notes that people write about a run, in a separate file beside the journal; no other file of the run is changed.

use crate::whole::write_whole;
use account::Notes;
use foreign::read_json;
use recording::journal_of;
use serde_json::{Map, Value};
use std::{io, path::Path};

/// File name of the notes in the folder of a run.
pub const NOTES_FILE: &str = "notes.json";
/// Maximum size of a file of notes, bytes: the maximum number of bookmarks, each with a text of maximum length.
const MOST_BYTES: u64 = 4 << 20;

/// Reads the notes about the run in a folder; empty if there is no file of notes.
///
/// # Errors
/// The file cannot be read or parsed. The error is a sentence with line and column.
pub fn read_notes(folder: &Path) -> Result<Notes, String> {
    let path = folder.join(NOTES_FILE);
    let is_long = path.metadata().is_ok_and(|file| file.len() > MOST_BYTES);
    if is_long {
        return Err(format!(
            "{}: larger than {} MB, the maximum for notes; correct or remove the file",
            path.display(),
            MOST_BYTES >> 20
        ));
    }
    let text = match read_json(&path, MOST_BYTES) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Notes::default()),
        Err(error) => return Err(format!("{}: {error}", path.display())),
    };
    // Without this check, a list would be read as the members of the object, in order.
    let object: Map<String, Value> =
        serde_json::from_str(&text).map_err(|error| not_understood(&path, &error))?;
    drop(object);
    let notes: Notes = serde_json::from_str(&text).map_err(|error| not_understood(&path, &error))?;
    notes.tidied().map_err(|why| format!("{}: {why}; correct or remove the file", path.display()))
}

/// The problem with the notes, with line and column.
fn not_understood(path: &Path, error: &serde_json::Error) -> String {
    let (line, column) = (error.line(), error.column());
    let sentence = error.to_string();
    let why = sentence.split_once(" at line ").map_or(sentence.as_str(), |(why, _)| why);
    format!("{}:{line}:{column}: {why}; correct or remove the file", path.display())
}

/// Writes the notes about the run in a folder atomically. If an existing file cannot be parsed, it is not overwritten.
///
/// # Errors
/// The existing file has one of the errors of [`read_notes`]; the folder no longer contains a run; or the system refuses
/// to write the file.
pub fn write_notes(folder: &Path, notes: &Notes) -> Result<(), String> {
    read_notes(folder)?;
    if !journal_of(folder).exists() {
        return Err(format!("{}: the run no longer exists", folder.display()));
    }
    let path = folder.join(NOTES_FILE);
    let text = serde_json::to_string_pretty(notes).map_err(|error| error.to_string())? + "\n";
    write_whole(&path, text.as_bytes()).map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use recording::JOURNAL_FILE;
    use std::fs;

    #[test]
    fn notes_are_kept_beside_the_journal_and_damaged_ones_are_named_and_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let mut notes = Notes::default();
        assert!(write_notes(folder.path(), &notes).unwrap_err().contains("the run no longer exists"));
        fs::write(folder.path().join(JOURNAL_FILE), "journal").unwrap();
        assert_eq!(read_notes(folder.path()), Ok(Notes::default()));
        notes.mark(12.5, "pump noise").unwrap();
        notes.remark("second pass").unwrap();
        write_notes(folder.path(), &notes).unwrap();
        assert_eq!(read_notes(folder.path()), Ok(notes.clone()));
        assert_eq!(fs::read(folder.path().join(JOURNAL_FILE)).unwrap(), b"journal");

        let long = format!("{{\"remark\": \"{}\"}}", "x".repeat(501));
        let huge = format!("{{\"remark\": \"{}\"}}", "x".repeat(10 << 20));
        for (damaged, why) in [
            ("{\n  \"remark\": 3\n}", "notes.json:2:13: invalid type: integer `3`"),
            ("[]", "notes.json:1:0: invalid type: sequence, expected a map"),
            (&long, "notes.json: remark: the text has 501 characters; the limit is 500"),
            (&huge, "notes.json: larger than 4 MB"),
        ] {
            fs::write(folder.path().join(NOTES_FILE), damaged).unwrap();
            for error in
                [read_notes(folder.path()).unwrap_err(), write_notes(folder.path(), &notes).unwrap_err()]
            {
                assert!(error.contains(why), "{error}");
            }
            assert_eq!(fs::read_to_string(folder.path().join(NOTES_FILE)).unwrap(), damaged);
        }
    }
}
