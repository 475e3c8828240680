//! The figures of a report beside those that its journal gives.

use report::Summary;
use serde_json::{Map, Value};
use std::collections::BTreeSet;

/// The first figure of a report that the journal gives otherwise, with both values; what is no event is not compared.
pub(super) fn difference(reported: Summary, computed: &Summary) -> Option<String> {
    let computed = Summary {
        wall_time_s: reported.wall_time_s,
        violations: reported.violations.clone(),
        planner_calls: reported.planner_calls,
        stops: reported.stops,
        events_sha256: reported.events_sha256.clone(),
        recording_sha256: reported.recording_sha256.clone(),
        logs: reported.logs.clone(),
        ..computed.clone()
    };
    // Through text, as the report went.
    let text = serde_json::to_string(&computed).ok()?;
    let computed = serde_json::to_value(serde_json::from_str::<Summary>(&text).ok()?).ok()?;
    let (key, reported, computed) =
        first_difference(String::new(), &serde_json::to_value(reported).ok()?, &computed)?;
    Some(format!("{key} is {reported}, the journal gives {computed}"))
}

/// The first place, as `floor.missed.3.area_m2`, where two values differ, with both as text.
fn first_difference(key: String, one: &Value, other: &Value) -> Option<(String, String, String)> {
    let below = |name: &str| if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
    match (one, other) {
        (one, other) if one == other => None,
        (Value::Object(ones), Value::Object(others)) => {
            let value = |map: &Map<String, Value>, name: &str| map.get(name).cloned().unwrap_or_default();
            let names: BTreeSet<&String> = ones.keys().chain(others.keys()).collect();
            names
                .into_iter()
                .find_map(|name| first_difference(below(name), &value(ones, name), &value(others, name)))
        }
        (Value::Array(ones), Value::Array(others)) if ones.len() == others.len() => {
            let mut pairs = ones.iter().zip(others).enumerate();
            pairs.find_map(|(index, (one, other))| first_difference(below(&index.to_string()), one, other))
        }
        (Value::Array(ones), Value::Array(others)) => {
            Some((key, format!("a list of {}", ones.len()), format!("one of {}", others.len())))
        }
        _ => Some((key, one.to_string(), other.to_string())),
    }
}
