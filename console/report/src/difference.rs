//! Finds the first place where two values differ.

use serde_json::{Map, Value};
use std::collections::BTreeSet;

/// The place where two values differ, with both values as text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// The path of the value, such as `floor.missed.3.area_m2`.
    pub key: String,
    /// The first value.
    pub one: String,
    /// The second value.
    pub other: String,
}

/// Returns the first place where two values differ; `None` if they are equal.
///
/// ```
/// let [one, other] = [4, 5].map(|n| serde_json::json!({ "a": 1, "b": [2, n] }));
/// let difference = report::first_difference(&one, &other).unwrap();
/// assert_eq!((&*difference.key, &*difference.one, &*difference.other), ("b.1", "4", "5"));
/// ```
pub fn first_difference(one: &Value, other: &Value) -> Option<Difference> {
    below(String::new(), one, other)
}

fn below(key: String, one: &Value, other: &Value) -> Option<Difference> {
    let at = |name: &str| if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
    match (one, other) {
        (one, other) if one == other => None,
        (Value::Object(ones), Value::Object(others)) => {
            let value = |map: &Map<String, Value>, name: &str| map.get(name).cloned().unwrap_or_default();
            let names: BTreeSet<&String> = ones.keys().chain(others.keys()).collect();
            names.into_iter().find_map(|name| below(at(name), &value(ones, name), &value(others, name)))
        }
        (Value::Array(ones), Value::Array(others)) if ones.len() == others.len() => {
            let mut pairs = ones.iter().zip(others).enumerate();
            pairs.find_map(|(index, (one, other))| below(at(&index.to_string()), one, other))
        }
        (Value::Array(ones), Value::Array(others)) => Some(Difference {
            one: format!("a list of length {}", ones.len()),
            other: format!("one of length {}", others.len()),
            key,
        }),
        (Value::String(ones), Value::String(others)) => {
            let same = ones.chars().zip(others.chars()).take_while(|(one, other)| one == other).count();
            // The first difference must be among the characters that are kept.
            let from = if same > BRIEF / 2 { same - BRIEF / 4 } else { 0 };
            let text = |text: &String| brief(&Value::from(text.chars().skip(from).collect::<String>()));
            Some(Difference { key, one: text(ones), other: text(others) })
        }
        _ => Some(Difference { key, one: brief(one), other: brief(other) }),
    }
}

/// Maximum number of characters of a value in a message.
const BRIEF: usize = 80;

/// A value as text that fits into a message.
fn brief(value: &Value) -> String {
    let text = match value {
        Value::Object(map) => map.keys().map(String::as_str).collect::<Vec<_>>().join(", "),
        _ => value.to_string(),
    };
    let kept =
        if text.chars().count() > BRIEF { text.chars().take(BRIEF).chain(['…']).collect() } else { text };
    if value.is_object() { format!("an object with the keys {kept}") } else { kept }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn long_values_are_shortened() {
        let [one, other] = [json!({ "a": { "b": 1, "c": 2 } }), json!({ "a": "x".repeat(100) })];
        let found = first_difference(&one, &other).unwrap();
        assert_eq!(found.one, "an object with the keys b, c");
        assert_eq!(found.other.chars().count(), BRIEF + 1);
    }
}
