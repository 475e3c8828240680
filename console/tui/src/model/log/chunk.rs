//! A chunk of the log: its lines and, separately, the data that a filter reads, packed for fast searching.

use super::entry::Entry;
use mission::Severity;
use serde::{Deserialize, Serialize};

/// The number of lines in a full chunk.
pub(super) const LINES: usize = 1024;
/// The separator between the source and the text; a character that is never typed.
const BETWEEN: char = '\u{1f}';

/// A chunk of the log.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Chunk {
    entries: Vec<Entry>,
    keys: Vec<Key>,
    /// The source and text of every line in lower case, one line after another.
    words: String,
}

/// The data that a filter reads, apart from the words.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Key {
    severity: Severity,
    t_s: f64,
    /// The end of the line's words.
    end: usize,
}

/// A line as seen by a filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Line<'a> {
    pub severity: Severity,
    /// Mission time, seconds.
    pub t_s: f64,
    /// Source and text in lower case.
    pub words: &'a str,
}

impl Line<'_> {
    /// The source, in lower case.
    pub(super) fn source(&self) -> &str {
        self.words.split(BETWEEN).next().unwrap_or_default()
    }
}

impl Chunk {
    pub(super) fn push(&mut self, entry: Entry) {
        self.words.push_str(&entry.source.to_lowercase());
        self.words.push(BETWEEN);
        self.words.push_str(&entry.text.to_lowercase());
        let (severity, t_s) = (entry.severity, entry.t_s);
        self.keys.push(Key { severity, t_s, end: self.words.len() });
        self.entries.push(entry);
    }

    /// Adds an entry with the same words as the last line.
    pub(super) fn repeat_last(&mut self, mut entry: Entry) {
        if let (Some(last), Some(key)) = (self.entries.last_mut(), self.keys.last_mut()) {
            entry.count = last.count.saturating_add(1);
            key.t_s = entry.t_s;
            *last = entry;
        }
    }

    pub(super) fn entries(&self) -> &[Entry] {
        &self.entries
    }

    pub(super) fn is_full(&self) -> bool {
        self.entries.len() >= LINES
    }

    /// The lines from an index on, as seen by a filter, with their indices.
    pub(super) fn lines(&self, from: usize) -> impl Iterator<Item = (usize, Line<'_>)> {
        let mut start = from.checked_sub(1).and_then(|before| self.keys.get(before)).map_or(0, |key| key.end);
        self.keys.iter().enumerate().skip(from).map(move |(index, key)| {
            let words = self.words.get(start..key.end).unwrap_or_default();
            start = key.end;
            (index, Line { severity: key.severity, t_s: key.t_s, words })
        })
    }

    /// The approximate memory use, bytes.
    pub(super) fn bytes(&self) -> usize {
        let entries: usize = self.entries.iter().map(Entry::bytes).sum();
        entries + self.words.len() + self.keys.len() * size_of::<Key>()
    }
}
