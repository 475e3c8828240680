//! Journals of older versions in today's words.

use mission::{Event, EventKind};
use serde_json::Value;

/// The first version with today's names.
pub(super) const RENAMED_IN: u32 = 4;

/// The first version that says of the tether only where it bends, and not where it begins and ends.
pub(super) const LINES_WITHOUT_ENDS_SINCE: u32 = 5;

/// Leaves of the whole line of the tether what is between its ends.
pub(super) fn cut_ends(event: &mut Event) {
    if let EventKind::Tethered { bends, .. } = &mut event.kind {
        bends.pop();
        bends.drain(..bends.len().min(1));
    }
}

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
/// The line is not JSON, or not an event even with today's names.
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
    fn of_a_whole_line_the_bends_are_left() {
        let line = |points: &str| {
            format!(
                r#"{{"tick":1,"t_s":0.1,"event":"tethered","length_m":1.0,"free_m":2.0,"contacts":[],"wrap_max_rad":0.0,
                    "wrap_total_rad":0.0,"pull_factor":1.0,"return_length_m":null,"line":{points}}}"#
            )
        };
        let bends = |points: &str| {
            let mut event: Event = serde_json::from_str(&line(points)).expect("an event");
            cut_ends(&mut event);
            let EventKind::Tethered { bends, .. } = event.kind else { panic!("another event") };
            bends.iter().map(|point| point.x).collect::<Vec<_>>()
        };
        assert_eq!(bends("[[0.0,0.0],[1.0,0.0],[2.0,0.0],[3.0,0.0]]"), [1.0, 2.0]);
        assert_eq!((bends("[[0.0,0.0],[1.0,0.0]]"), bends("[]")), (vec![], vec![]));
    }

    #[test]
    fn keys_and_words_are_renamed_and_texts_are_not() {
        let old = json!({ "event": "tether_alarmed", "alarm": { "sum_of_wraps": { "sum_rad": 2.0 } }, "parameters": { "reel_m": 1 }, "text": "planner_said" });
        let new = json!({ "event": "tether_alarm_raised", "alarm": { "wrap_total": { "sum_rad": 2.0 } }, "parameters": { "reel_m": 1 }, "text": "planner_said" });
        assert_eq!(with_todays_names(old), new);
        assert_eq!(with_todays_names(new.clone()), new);
    }
}
