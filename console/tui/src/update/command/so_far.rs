//! What is wrong with the values of a command line while it is being typed.

use super::{candidates, line, read_with, value};
use crate::actions::{Kind, find};
use crate::model::{Model, palette::LineFault};

/// Texts that may complete a value: digits, a unit, a second coordinate, a time. The value that is being typed is wrong
/// only if no such text makes it right.
#[rustfmt::skip]
const MORE: [&str; 16] =
    ["0", "1", "5", "9", ".5", ".05", "5.5", "00", "s", "5s", ",0", "0,0", "0:01", ":01", "1:01:01", "+1:01:01"];

/// The first value of a line that is wrong, whatever is typed next; `text` is the line, `before` its part before the cursor.
/// A value that is missing is not wrong yet.
pub(in crate::update) fn fault(model: &Model, text: &str, before: &str) -> Option<LineFault> {
    // A quote that is open can still be closed.
    let words = line::words(text).ok()?;
    let (name, values) = words.split_first()?;
    let is_command = find::named(&name.text).is_some() || model.console.keys.aliases.contains_key(&name.text);
    if !is_command || values.is_empty() {
        return None;
    }
    let is_open = before.len() == text.len() && !text.ends_with(char::is_whitespace);
    let open = values.last().filter(|_| is_open);
    let is_listed = open.is_some() && candidates(model, before).is_some_and(|values| !values.is_empty());
    let value = |kind: Kind, typed: &str| {
        let may_continue = open.is_some_and(|open| open.text.ends_with(typed));
        match value::read(model, kind, typed) {
            Err(_) if may_continue && (is_listed || may_become_right(model, kind, typed)) => Ok(()),
            other => other.map(drop),
        }
    };
    let fault = read_with(&model.console.keys, text, &value).err()?;
    (fault.at.start < text.len()).then_some(fault)
}

/// Whether more text can make a value right.
fn may_become_right(model: &Model, kind: Kind, typed: &str) -> bool {
    MORE.iter().any(|more| value::read(model, kind, &format!("{typed}{more}")).is_ok())
}
