//! Reads a table in a plan: its values by key, and everything that is wrong with it, with line, key and remedy.

use mission::spelling::nearest;
use scenario::{Complaint, Problem};
use std::{cell::RefCell, ops::Range};
use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

/// A value with its position in the text.
pub(crate) type Placed<'a> = Spanned<DeValue<'a>>;

/// A table in a plan.
pub(crate) struct Reader<'a> {
    text: &'a str,
    table: &'a DeTable<'a>,
    path: String,
    problems: &'a RefCell<Vec<Problem>>,
}

impl<'a> Reader<'a> {
    /// Creates a reader for a table with these keys. Every other key is reported as a problem, unless the list of keys is
    /// empty.
    pub(crate) fn new(
        text: &'a str,
        table: &'a DeTable<'a>,
        path: &str,
        keys: &[&str],
        problems: &'a RefCell<Vec<Problem>>,
    ) -> Self {
        let reader = Self { text, table, path: path.to_owned(), problems };
        let unknown = |name: &&str| !keys.is_empty() && !keys.contains(name);
        for (name, _) in table.iter().filter(|(name, _)| unknown(&&**name.get_ref())) {
            let remedy = match nearest(name.get_ref(), keys.iter().copied()) {
                Some(key) => format!("did you mean `{key}`?"),
                None => format!("known here: {}", keys.join(", ")),
            };
            reader.note(name.get_ref(), name.span(), None, Complaint::UnknownKey { remedy });
        }
        reader
    }

    fn note(&self, name: &str, at: Range<usize>, value: Option<String>, what: Complaint) {
        let key = if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) };
        self.problems.borrow_mut().push(Problem { key, value, at: Some(at), what });
    }

    /// Records a problem with the value of a key.
    pub(crate) fn complain(&self, name: &str, at: Range<usize>, what: Complaint) {
        let written = self.text.get(at.clone()).unwrap_or_default();
        let shown: String =
            written.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(40).collect();
        self.note(name, at, Some(shown), what);
    }

    fn wrong(&self, name: &str, value: &Placed<'_>, wanted: &str, remedy: &str) {
        let what = Complaint::WrongType { wanted: wanted.into(), remedy: remedy.into() };
        self.complain(name, value.span(), what);
    }

    /// The position of a key's value, or the start of the file if the key is missing.
    pub(crate) fn place(&self, name: &str) -> Range<usize> {
        self.get(name).map_or(0..0, Spanned::span)
    }

    /// The value of a key.
    pub(crate) fn get(&self, name: &str) -> Option<&'a Placed<'a>> {
        self.table.get(name)
    }

    /// All keys with their values, in the order in which they appear in the text.
    pub(crate) fn entries(&self) -> Vec<(String, &'a Placed<'a>)> {
        let mut entries: Vec<_> =
            self.table.iter().map(|(name, value)| (name.get_ref().to_string(), value)).collect();
        entries.sort_by_key(|(_, value)| value.span().start);
        entries
    }

    /// A nested table with these keys.
    pub(crate) fn table(&self, name: &str, keys: &[&str]) -> Option<Self> {
        let value = self.get(name)?;
        let Some(table) = value.get_ref().as_table() else {
            self.wrong(name, value, "a table", "write { key = value, ... }, or the keys below a [header]");
            return None;
        };
        let path = if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) };
        Some(Self::new(self.text, table, &path, keys, self.problems))
    }

    /// A word.
    pub(crate) fn word(&self, name: &str) -> Option<String> {
        let value = self.get(name)?;
        let word = value.get_ref().as_str().filter(|word| !word.is_empty());
        if word.is_none() {
            self.wrong(name, value, "a word", "write it in quotes");
        }
        word.map(str::to_owned)
    }

    /// A list of words, each with its position; empty if the key is missing.
    pub(crate) fn words(&self, name: &str) -> Vec<(String, Range<usize>)> {
        let Some(value) = self.get(name) else { return Vec::new() };
        let entries = value.get_ref().as_array().map(|list| list.iter().collect::<Vec<_>>());
        let words: Option<Vec<_>> = entries.and_then(|entries| {
            let word = |entry: &Placed<'a>| Some((entry.get_ref().as_str()?.to_owned(), entry.span()));
            entries.into_iter().map(word).collect()
        });
        words.unwrap_or_else(|| {
            self.wrong(name, value, "a list of words", "write [\"one\", \"two\"]");
            Vec::new()
        })
    }

    /// A flag; false if the key is missing.
    pub(crate) fn flag(&self, name: &str) -> bool {
        let Some(value) = self.get(name) else { return false };
        value.get_ref().as_bool().unwrap_or_else(|| {
            self.wrong(name, value, "true or false", "write it without quotes");
            false
        })
    }

    /// A finite number.
    pub(crate) fn number(&self, name: &str) -> Option<f64> {
        let value = self.get(name)?;
        let number = crate::Value::read(value.get_ref()).and_then(|value| value.number());
        if number.is_none() {
            self.wrong(name, value, "a finite number", "write it without quotes");
        }
        number
    }

    /// A whole number within a range.
    pub(crate) fn whole(&self, name: &str, range: Range<u64>) -> Option<u64> {
        let value = self.get(name)?;
        let whole = match crate::Value::read(value.get_ref()) {
            Some(crate::Value::Whole(n)) => u64::try_from(n).ok().filter(|n| range.contains(n)),
            _ => None,
        };
        if whole.is_none() {
            let must_be = format!("a whole number from {} to {}", range.start, range.end - 1);
            self.complain(name, value.span(), Complaint::OutOfRange(must_be));
        }
        whole
    }

    /// Records that a key is missing.
    pub(crate) fn require(&self, name: &str, remedy: &str) {
        if self.get(name).is_none() {
            self.note(name, 0..0, None, Complaint::Missing { remedy: remedy.to_owned() });
        }
    }
}
