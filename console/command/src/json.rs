//! Output of results as JSON.

use anyhow::Context;
use foreign::plain_json;
use report::print::say_line;
use serde::Serialize;

/// Formats a value as indented JSON for people to read, with unsafe characters escaped; error messages call it `name`.
///
/// # Errors
/// The value cannot be written as JSON.
pub fn pretty_json(name: &str, value: &impl Serialize) -> anyhow::Result<String> {
    let text = serde_json::to_string_pretty(value).with_context(|| format!("writing {name} as JSON"))?;
    Ok(plain_json(&text).into_owned() + "\n")
}

/// Prints a value on stdout as a line of JSON; error messages call it `name`.
///
/// # Errors
/// The value cannot be written as JSON, or stdout is closed.
pub fn say_json(name: &str, value: &impl Serialize) -> anyhow::Result<()> {
    let text = serde_json::to_string(value).with_context(|| format!("writing {name} as JSON"))?;
    Ok(say_line(&plain_json(&text))?)
}
