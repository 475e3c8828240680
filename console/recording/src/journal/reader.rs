//! Reading a journal, also one whose writer was killed.

use super::JournalError;
use mission::{Event, event::JOURNAL_VERSION};
use serde::Deserialize;
use std::{
    fs::File,
    io::{BufRead, BufReader},
    path::{Path, PathBuf},
};

/// A journal in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Journal {
    /// Its events, oldest first.
    pub events: Vec<Event>,
    /// If the last line is cut off, because the writer was killed or the disk was full: what is missing.
    pub truncated: Option<String>,
}

/// Reads a whole journal.
///
/// # Errors
/// See [`JournalError`]; a last line that is cut off is no error.
pub fn read_journal(path: &Path) -> Result<Journal, JournalError> {
    let mut reader = JournalReader::open(path)?;
    let events = reader.by_ref().collect::<Result<_, _>>()?;
    Ok(Journal { events, truncated: reader.truncated })
}

/// Reads a journal event by event.
///
/// Ends after the first error.
pub struct JournalReader {
    lines: Box<dyn BufRead + Send>,
    path: PathBuf,
    text: Vec<u8>,
    line: usize,
    ended: bool,
    truncated: Option<String>,
}

/// What a journal of any version tells in its first line.
#[derive(Deserialize)]
struct Head {
    event: String,
    journal_version: u32,
}

impl JournalReader {
    /// Opens a journal.
    ///
    /// # Errors
    /// [`JournalError::Read`] if there is none.
    pub fn open(path: &Path) -> Result<Self, JournalError> {
        let file = File::open(path).map_err(|error| read_error(path, &error))?;
        Ok(Self {
            lines: Box::new(BufReader::with_capacity(1 << 18, file)),
            path: path.to_owned(),
            text: Vec::new(),
            line: 0,
            ended: false,
            truncated: None,
        })
    }

    /// After the end: what is missing, if the last line is cut off.
    pub fn truncated(&self) -> Option<&str> {
        self.truncated.as_deref()
    }

    fn read_event(&mut self) -> Result<Option<Event>, JournalError> {
        self.text.clear();
        let length =
            self.lines.read_until(b'\n', &mut self.text).map_err(|error| read_error(&self.path, &error))?;
        self.line += 1;
        let whole = self.text.last() == Some(&b'\n');
        match self.parse() {
            _ if length == 0 => Ok(self.end_of_file()),
            Ok(event) => Ok(Some(event)),
            Err(error @ JournalError::Newer { .. }) => Err(error),
            Err(_) if !whole => Ok(self.torn(length)),
            Err(error) => Err(error),
        }
    }

    fn end_of_file(&mut self) -> Option<Event> {
        self.ended = true;
        if self.line == 1 {
            self.truncated = Some("the journal is empty".into());
        }
        None
    }

    fn torn(&mut self, length: usize) -> Option<Event> {
        self.ended = true;
        self.truncated = Some(format!("line {}, the last one, is cut off after {length} bytes", self.line));
        None
    }

    fn parse(&self) -> Result<Event, JournalError> {
        if self.line == 1 {
            self.check_head()?;
        }
        serde_json::from_slice(&self.text).map_err(|error| JournalError::Damaged {
            line: self.line,
            column: error.column().max(1),
            why: without_position(&error),
            path: self.path.clone(),
        })
    }

    fn check_head(&self) -> Result<(), JournalError> {
        let refuse = |why| JournalError::NotAJournal { why, path: self.path.clone() };
        let head: Head =
            serde_json::from_slice(&self.text).map_err(|error| refuse(without_position(&error)))?;
        if head.event != "run_opened" {
            return Err(refuse(format!("it is {}", head.event)));
        }
        if head.journal_version > JOURNAL_VERSION {
            let theirs = head.journal_version;
            return Err(JournalError::Newer { theirs, ours: JOURNAL_VERSION, path: self.path.clone() });
        }
        Ok(())
    }
}

impl Iterator for JournalReader {
    type Item = Result<Event, JournalError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ended {
            return None;
        }
        let event = self.read_event();
        self.ended |= event.is_err();
        event.transpose()
    }
}

/// The parser's sentence without its own "at line 1 column 7": every line is a document of its own to it.
fn without_position(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.split_once(" at line ").map_or(text.clone(), |(sentence, _)| sentence.to_owned())
}

fn read_error(path: &Path, error: &std::io::Error) -> JournalError {
    JournalError::Read { why: error.to_string(), path: path.to_owned() }
}
