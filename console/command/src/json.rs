//! Results as JSON.

use anyhow::Context;
use foreign::plain_json;
use report::print::say_line;
use serde::Serialize;

/// A value as JSON for people to read, in plain characters; `name` is what an error calls it.
///
/// # Errors
/// It cannot be written as JSON, or stdout is closed.
pub fn pretty_json(name: &str, value: &impl Serialize) -> anyhow::Result<String> {
    let text = serde_json::to_string_pretty(value).with_context(|| format!("writing {name} as JSON"))?;
    Ok(plain_json(&text).into_owned() + "\n")
}

/// Writes a value to stdout as a line of JSON; `name` is what an error calls it.
///
/// # Errors
/// It cannot be written as JSON, or stdout is closed.
pub fn say_json(name: &str, value: &impl Serialize) -> anyhow::Result<()> {
    let text = serde_json::to_string(value).with_context(|| format!("writing {name} as JSON"))?;
    Ok(say_line(&plain_json(&text))?)
}
