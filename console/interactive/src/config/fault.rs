//! Faults in configuration files, and their positions.

use mission::spelling::nearest;
use toml_edit::{Document, Item, TableLike};

/// A fault at a position in a configuration file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fault {
    /// The byte offset in the text.
    pub at: usize,
    /// The problem, as a clause; a second clause may state its consequence.
    pub what: String,
    /// The byte offset of a second position that is part of the problem.
    pub other: Option<usize>,
    /// The consequence, as a clause; empty if `what` already states it.
    pub instead: String,
    /// Whether the line takes effect nevertheless.
    pub is_warning: bool,
}

/// A text and its name, for locating positions.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub name: &'a str,
    pub text: &'a str,
}

impl Place<'_> {
    /// The name, line and column of a byte offset.
    fn of(self, at: usize) -> String {
        let before = &self.text.as_bytes()[..at.min(self.text.len())];
        let line = before.split(|byte| *byte == b'\n').count();
        let begin = before.iter().rposition(|byte| *byte == b'\n').map_or(0, |newline| newline + 1);
        let column = 1 + String::from_utf8_lossy(&before[begin..]).chars().count();
        format!("{}:{line}:{column}", self.name)
    }
}

impl Fault {
    /// A fault that causes its line to be ignored.
    pub(super) fn new(at: usize, what: String) -> Self {
        Self { at, what, other: None, instead: "the line is ignored".into(), is_warning: false }
    }

    /// The fault as one line, with all its positions.
    pub(super) fn text(&self, place: Place<'_>) -> String {
        let other = self.other.map(|at| format!(", {}", place.of(at))).unwrap_or_default();
        let instead = if self.instead.is_empty() { String::new() } else { format!("; {}", self.instead) };
        format!("{}: {}{other}{instead}", place.of(self.at), self.what)
    }
}

/// Parses a text as TOML; an invalid text is ignored as a whole.
pub(super) fn document<'a>(text: &'a str, faults: &mut Vec<Fault>) -> Option<Document<&'a str>> {
    match Document::parse(text) {
        Ok(document) => Some(document),
        Err(error) => {
            let at = error.span().map_or(0, |span| span.start);
            let what = format!("invalid TOML: {}", error.message().lines().collect::<Vec<_>>().join(", "));
            faults.push(Fault { instead: "the file is ignored".into(), ..Fault::new(at, what) });
            None
        }
    }
}

/// Passes every key of a table to `take`; unknown keys and errors of `take` are faults.
pub(super) fn each(
    table: &dyn TableLike,
    known: &[&str],
    faults: &mut Vec<Fault>,
    mut take: impl FnMut(&str, &Item, &mut Vec<Fault>) -> Result<(), String>,
) {
    for (key, item) in table.iter() {
        if known.contains(&key) {
            if let Err(what) = take(key, item, faults) {
                faults.push(Fault::new(start(item), format!("{key} {what}")));
            }
            continue;
        }
        let at = table.key(key).and_then(toml_edit::Key::span).map_or(0, |span| span.start);
        let remedy = nearest(key, known.iter().copied()).map(|name| format!("; did you mean {name}?"));
        faults.push(Fault::new(at, format!("unknown key {key:?}{}", remedy.unwrap_or_default())));
    }
}

/// The byte offset at which an item begins.
pub(super) fn start(item: &Item) -> usize {
    item.span().map_or(0, |span| span.start)
}
