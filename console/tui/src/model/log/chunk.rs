//! A stretch of the log: its lines, and beside them what a filter looks at, packed so that it is found fast.

use super::entry::Entry;
use mission::Severity;
use serde::{Deserialize, Serialize};

/// Lines of a full chunk.
pub(super) const LINES: usize = 1024;
/// Between source and text; nobody types it.
const BETWEEN: char = '\u{1f}';

/// A stretch of the log.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Chunk {
    entries: Vec<Entry>,
    keys: Vec<Key>,
    /// Source and text of every line in small letters, one behind the other.
    words: String,
}

/// What a filter looks at, apart from words.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Key {
    severity: Severity,
    t_s: f64,
    /// Where its words end.
    end: usize,
}

/// A line as a filter sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Line<'a> {
    pub severity: Severity,
    /// Mission time, seconds.
    pub t_s: f64,
    /// Source and text in small letters.
    pub words: &'a str,
}

impl Line<'_> {
    /// Who speaks, in small letters.
    pub(super) fn source(&self) -> &str {
        self.words.split(BETWEEN).next().unwrap_or_default()
    }
}

impl Chunk {
    pub(super) fn push(&mut self, entry: Entry) {
        self.words.push_str(&entry.source.to_lowercase());
        self.words.push(BETWEEN);
        self.words.push_str(&entry.text.to_lowercase());
        self.keys.push(Key { severity: entry.severity, t_s: entry.t_s, end: self.words.len() });
        self.entries.push(entry);
    }

    /// The last line once more, as another one of the same words.
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

    /// The lines from an index on, as a filter sees them, each with its index.
    pub(super) fn lines(&self, from: usize) -> impl Iterator<Item = (usize, Line<'_>)> {
        let mut start = from.checked_sub(1).and_then(|before| self.keys.get(before)).map_or(0, |key| key.end);
        self.keys.iter().enumerate().skip(from).map(move |(index, key)| {
            let words = self.words.get(start..key.end).unwrap_or_default();
            start = key.end;
            (index, Line { severity: key.severity, t_s: key.t_s, words })
        })
    }

    /// Memory that it takes, bytes; near enough.
    pub(super) fn bytes(&self) -> usize {
        let entries: usize = self.entries.iter().map(Entry::bytes).sum();
        entries + self.words.len() + self.keys.len() * size_of::<Key>()
    }
}
