//! Journals of older versions in today's words.

use mission::Event;
use serde_json::Value;

/// The first version with today's names.
pub(super) const RENAMED_IN: u32 = 4;

/// Keys of version 3 and before, and their names since version 4.
const KEYS: &[(&str, &str)] = &[
    ("max_wrap_rad", "wrap_max_rad"),
    ("sum_wrap_rad", "wrap_total_rad"),
    ("max_sum_wrap_rad", "wrap_total_max_rad"),
    ("max_total_wrap_rad", "wrap_total_max_rad"),
    ("max_cable_m", "tether_length_max_m"),
    ("max_length_m", "tether_length_max_m"),
    ("left_out_m", "end_length_m"),
    ("reel_m", "reel_length_m"),
    ("min_clearance_m", "clearance_min_m"),
    ("fly_uncertified", "allow_uncertified"),
    ("calibrates_sound", "calibrate_sound_speed"),
    ("needs_sight", "needs_line_of_sight"),
    ("lost_hold_s", "position_lost_hold_s"),
    ("lost_s", "position_lost_s"),
    ("way_home", "return_path"),
    ("way_home_m", "return_length_m"),
    ("unmet", "violations"),
    ("catches", "snags"),
    ("caught", "snagged"),
    ("sum_of_wraps", "wrap_total"),
];

/// Names of events, hold reasons and alarms of version 3 and before, and their names since version 4.
const WORDS: &[(&str, &str)] = &[
    ("station_excluded", "station_rejected"),
    ("station_regained", "station_restored"),
    ("planner_said", "planner_logged"),
    ("tether_alarmed", "tether_alarm_raised"),
    ("tether_eased", "tether_alarm_cleared"),
    ("position_alarmed", "ranges_inconsistent"),
    ("position_trusted", "ranges_consistent"),
    ("no_way_home", "no_return_path"),
];

/// Keys whose values are words of the format; all other texts are an author's and stay.
const WORD_KEYS: &[&str] = &["event", "by", "alarm"];

/// An event of an older version.
///
/// # Errors
/// The line is no JSON, or no event even with today's names.
pub(super) fn event(line: &[u8]) -> serde_json::Result<Event> {
    serde_json::from_value(with_todays_names(serde_json::from_slice(line)?))
}

/// A journal's line or a run's report of an older version with today's names; what has them already stays as it is.
pub fn with_todays_names(value: Value) -> Value {
    match value {
        Value::Array(all) => all.into_iter().map(with_todays_names).collect(),
        Value::Object(all) => all.into_iter().map(renamed).collect(),
        other => other,
    }
}

fn renamed((key, value): (String, Value)) -> (String, Value) {
    let value = match value {
        Value::String(word) if WORD_KEYS.contains(&key.as_str()) => Value::String(todays(WORDS, word)),
        // Names of parameters are the planner's.
        own if key == "parameters" => own,
        other => with_todays_names(other),
    };
    (todays(KEYS, key), value)
}

fn todays(names: &[(&str, &str)], name: String) -> String {
    names.iter().find(|(old, _)| *old == name).map_or(name, |(_, new)| (*new).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn keys_and_words_are_renamed_and_texts_are_not() {
        let old = json!({ "event": "tether_alarmed", "alarm": { "sum_of_wraps": { "sum_rad": 2.0 } }, "parameters": { "reel_m": 1 }, "text": "planner_said" });
        let new = json!({ "event": "tether_alarm_raised", "alarm": { "wrap_total": { "sum_rad": 2.0 } }, "parameters": { "reel_m": 1 }, "text": "planner_said" });
        assert_eq!(with_todays_names(old), new);
        assert_eq!(with_todays_names(new.clone()), new);
    }
}
