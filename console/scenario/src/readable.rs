//! Checks that every name and fact in a file can be read as written. Characters that are invisible, or that change how
//! the text around them appears, are refused; in comments they are allowed.

use super::{
    problem::{Complaint, Problem},
    source::Source,
};
use foreign::unplain;
use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

/// Complains about every text and every key that contains such a character.
pub(crate) fn check(source: &Source<'_>, table: &DeTable<'_>) {
    of_table(source, "", table);
}

fn of_table(source: &Source<'_>, path: &str, table: &DeTable<'_>) {
    for (key, value) in table {
        let name: &str = key.get_ref();
        let path = if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
        complain(source, &path, name, key.span());
        of_value(source, &path, value);
    }
}

fn of_value(source: &Source<'_>, path: &str, value: &Spanned<DeValue<'_>>) {
    match value.get_ref() {
        DeValue::String(text) => complain(source, path, text, value.span()),
        DeValue::Array(values) => {
            for (index, value) in values.iter().enumerate() {
                of_value(source, &format!("{path}.{index}"), value);
            }
        }
        DeValue::Table(table) => of_table(source, path, table),
        _ => {}
    }
}

fn complain(source: &Source<'_>, path: &str, text: &str, at: std::ops::Range<usize>) {
    let Some(odd) = unplain(text) else { return };
    let what = Complaint::OutOfRange(format!("text without control or invisible characters; contains {odd}"));
    let (key, value) = (foreign::plain(path).into_owned(), Some(source.excerpt(&at)));
    source.note(Problem { key, value, at: Some(at), what });
}
