//! The command lines of earlier sessions: the file `history` in the XDG state folder, one per line, newest last.
//! Failures to read or write the file are ignored.

use planner_host::user_folder;
use std::{
    fs::{self, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

/// The largest number of command lines that are recalled.
const RECALLED: usize = 100;
/// If the file has more lines than this, the oldest are dropped.
const MOST: usize = 1000;

/// Loads the command lines of earlier sessions without duplicates, newest last.
pub(super) fn load() -> Vec<String> {
    file().map_or_else(Vec::new, |file| load_from(&file))
}

/// Appends a command line.
pub(super) fn append(line: &str) {
    // The console works without its history.
    let _ = file().map(|file| append_to(&file, line));
}

fn file() -> Option<PathBuf> {
    user_folder("XDG_STATE_HOME", ".local/state").map(|folder| folder.join("history"))
}

fn load_from(file: &Path) -> Vec<String> {
    let text = if file.is_file() { fs::read(file).unwrap_or_default() } else { Vec::new() };
    let text = String::from_utf8_lossy(&text);
    let mut recalled: Vec<String> = Vec::new();
    for line in text.lines().rev().map(str::trim).filter(|line| !line.is_empty()) {
        if recalled.len() < RECALLED && !recalled.iter().any(|later| later == line) {
            recalled.push(line.replace(char::is_control, ""));
        }
    }
    recalled.reverse();
    if text.lines().count() > MOST {
        // Replace the file as a whole; another console may be reading it.
        let _ = runs::write_whole(file, (recalled.join("\n") + "\n").as_bytes());
    }
    recalled
}

fn append_to(file: &Path, line: &str) -> io::Result<()> {
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder)?;
    }
    let mut file = OpenOptions::new().append(true).create(true).open(file)?;
    // Write the line in one call, so that the lines of two consoles do not mix.
    file.write_all(format!("{line}\n").as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_recalled_once_and_the_newest_last() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("tankops").join("history");
        assert_eq!(load_from(&file), Vec::<String>::new(), "there is none at first");
        for line in ["speed 2", "verify latest", "speed 2"] {
            append_to(&file, line).expect("writable");
        }
        assert_eq!(load_from(&file), ["verify latest", "speed 2"]);
    }

    #[test]
    fn the_file_stays_short() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("history");
        let lines: Vec<String> = (0..=MOST).map(|n| format!("speed {n}")).collect();
        fs::write(&file, lines.join("\n")).expect("writable");
        let recalled = load_from(&file);
        assert_eq!((recalled.len(), recalled.last().map(String::as_str)), (RECALLED, Some("speed 1000")));
        assert_eq!(fs::read_to_string(&file).expect("readable").lines().count(), RECALLED);
    }

    #[test]
    fn what_is_no_text_and_no_file_does_no_harm() {
        let folder = tempfile::tempdir().expect("a folder");
        assert_eq!(load_from(folder.path()), Vec::<String>::new());
        assert!(append_to(folder.path(), "speed 2").is_err());
        let file = folder.path().join("history");
        fs::write(&file, b"\xff\xfe\nsp\x1beed 2\n").expect("writable");
        assert_eq!(load_from(&file).last().map(String::as_str), Some("speed 2"));
    }
}
