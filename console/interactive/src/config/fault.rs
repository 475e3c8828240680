//! What is wrong with a configuration file, and where.

use mission::spelling::nearest;
use toml_edit::{Document, Item, TableLike};

/// What is wrong with a place of a configuration file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fault {
    /// Byte of the text.
    pub at: usize,
    /// What is wrong, and what happens instead, as clauses.
    pub what: String,
    /// Byte of another place that has to do with it.
    pub other: Option<usize>,
    /// What happens instead, as a clause; empty where `what` says it.
    pub instead: String,
    /// Whether the line is taken all the same.
    pub is_warning: bool,
}

/// A text and its name, to say where something is.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub name: &'a str,
    pub text: &'a str,
}

impl Place<'_> {
    /// Name, line and column of a byte.
    fn of(self, at: usize) -> String {
        let before = &self.text.as_bytes()[..at.min(self.text.len())];
        let line = before.split(|byte| *byte == b'\n').count();
        let begin = before.iter().rposition(|byte| *byte == b'\n').map_or(0, |newline| newline + 1);
        let column = 1 + String::from_utf8_lossy(&before[begin..]).chars().count();
        format!("{}:{line}:{column}", self.name)
    }
}

impl Fault {
    /// A line that is ignored.
    pub(super) fn new(at: usize, what: String) -> Self {
        Self { at, what, other: None, instead: "the line is ignored".into(), is_warning: false }
    }

    /// As a line, with every place named.
    pub(super) fn text(&self, place: Place<'_>) -> String {
        let other = self.other.map(|at| format!(", {}", place.of(at))).unwrap_or_default();
        let instead = if self.instead.is_empty() { String::new() } else { format!("; {}", self.instead) };
        format!("{}: {}{other}{instead}", place.of(self.at), self.what)
    }
}

/// Reads a text as TOML; one that is not is ignored as a whole.
pub(super) fn document<'a>(text: &'a str, faults: &mut Vec<Fault>) -> Option<Document<&'a str>> {
    match Document::parse(text) {
        Ok(document) => Some(document),
        Err(error) => {
            let at = error.span().map_or(0, |span| span.start);
            let what = format!("not TOML: {}", error.message().lines().collect::<Vec<_>>().join(", "));
            faults.push(Fault { instead: "the file is ignored".into(), ..Fault::new(at, what) });
            None
        }
    }
}

/// Takes every key of a table; an unknown one and one that is not taken are faults.
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

/// Where an item begins.
pub(super) fn start(item: &Item) -> usize {
    item.span().map_or(0, |span| span.start)
}
