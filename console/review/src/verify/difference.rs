//! A line of a journal that differs when it is recomputed: the first one as text of a few lines, and whether it only lacks
//! values that an earlier build did not record.

use recording::Difference;
use report::first_difference;
use serde_json::Value;
use std::collections::BTreeSet;

/// Maximum number of characters of an event that is printed as it is.
const WHOLE: usize = 100;
/// Number of characters printed from the first difference on, and before it.
const AFTER: usize = 60;
const BEFORE: usize = 20;

/// The difference as text: short events as they are; of long ones, the path and both values.
pub(super) fn text(Difference { tick, recorded, computed }: &Difference) -> String {
    let (place, recorded, computed) = if is_short(recorded) && is_short(computed) {
        (String::new(), recorded.clone(), computed.clone())
    } else {
        values(recorded, computed).unwrap_or_else(|| {
            let [recorded, computed] = beside([recorded, computed]);
            (String::new(), recorded, computed)
        })
    };
    format!("different from tick {tick} on{place}\n  recorded: {recorded}\n  computed: {computed}")
}

/// The values that the recorded event lacks, as `tethered.measured`, if this is the only difference: an earlier build, which
/// did not know them, wrote the rest of the event. `None` if anything else differs.
pub(super) fn unrecorded(Difference { recorded, computed, .. }: &Difference) -> Option<BTreeSet<String>> {
    let [recorded, computed] = [recorded, computed].map(|line| serde_json::from_str::<Value>(line).ok());
    let (recorded, computed) = (recorded?, computed?);
    let kind = recorded["event"].as_str().filter(|kind| computed["event"] == **kind)?;
    let mut missing = BTreeSet::new();
    (lacks_only(kind, &recorded, &computed, &mut missing) && !missing.is_empty()).then_some(missing)
}

/// Whether a recorded value equals the computed one except for keys that it lacks; these are added to `missing` below `path`.
fn lacks_only(path: &str, recorded: &Value, computed: &Value, missing: &mut BTreeSet<String>) -> bool {
    match (recorded, computed) {
        (Value::Object(recorded), Value::Object(computed)) => {
            let is_known = recorded.keys().all(|key| computed.contains_key(key));
            is_known
                && computed.iter().all(|(key, computed)| {
                    let path = format!("{path}.{key}");
                    if let Some(recorded) = recorded.get(key) {
                        lacks_only(&path, recorded, computed, missing)
                    } else {
                        missing.insert(path);
                        true
                    }
                })
        }
        (Value::Array(recorded), Value::Array(computed)) => {
            let mut pairs = recorded.iter().zip(computed);
            recorded.len() == computed.len()
                && pairs.all(|(recorded, computed)| lacks_only(path, recorded, computed, missing))
        }
        _ => recorded == computed,
    }
}

fn is_short(event: &str) -> bool {
    event.chars().count() <= WHOLE
}

/// The place of the first difference in two events of one kind, and both values; `None` if the events have different
/// kinds, or differ in their spelling only.
fn values(recorded: &str, computed: &str) -> Option<(String, String, String)> {
    let [recorded, computed] = [recorded, computed].map(|line| serde_json::from_str::<Value>(line).ok());
    let (recorded, computed) = (recorded?, computed?);
    let kind = recorded["event"].as_str().filter(|kind| computed["event"] == **kind)?;
    let found = first_difference(&recorded, &computed)?;
    let path = cut(&found.key, AFTER + BEFORE);
    Some((format!(", event {kind}, {path}"), found.one, found.other))
}

/// Two texts, each cut to the surroundings of the first character that differs.
fn beside(texts: [&str; 2]) -> [String; 2] {
    let [one, other] = texts.map(|text| text.chars().collect::<Vec<char>>());
    let same = one.iter().zip(&other).take_while(|(one, other)| one == other).count();
    let from = same.saturating_sub(BEFORE);
    [one, other].map(|text| {
        let rest: String = text.iter().skip(from).collect();
        let begin = if from > 0 { "\u{2026}" } else { "" };
        format!("{begin}{}", cut(&rest, BEFORE + AFTER))
    })
}

fn cut(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most).chain(['\u{2026}']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(recorded: &str, computed: &str) -> String {
        let text = text(&Difference { tick: 3, recorded: recorded.into(), computed: computed.into() });
        assert!(text.chars().count() <= 300, "{} characters: {text}", text.chars().count());
        text
    }

    #[test]
    fn of_long_events_only_the_place_and_both_values_are_printed() {
        let floor = "1,".repeat(9000);
        let event = |seed: u32, kind: &str| {
            format!(
                "{{\"tick\":3,\"event\":\"{kind}\",\"floor\":[{floor}0],\"mission\":{{\"seed\":{seed}}}}}"
            )
        };
        assert_eq!(
            said(&event(1, "run_opened"), &event(2, "run_opened")),
            "different from tick 3 on, event run_opened, mission.seed\n  recorded: 1\n  computed: 2"
        );
        let other_kind = said(&event(1, "run_opened"), &event(1, "planned"));
        assert!(other_kind.contains("run_opened") && other_kind.contains("planned"), "{other_kind}");
        let spelling = said(&event(1, "planned"), &event(1, "planned").replace(":1}", ": 1}"));
        assert!(spelling.contains("\"seed\":1}") && spelling.contains("\"seed\": 1}"), "{spelling}");
        let none = said(&event(1, "planned"), "nothing more in this tick");
        assert!(none.contains("computed: nothing more in this tick"), "{none}");
    }

    #[test]
    fn only_an_event_that_lacks_values_and_differs_in_nothing_else_is_that_of_an_earlier_build() {
        let lacks = |recorded: &str, computed: &str| {
            let difference = Difference { tick: 3, recorded: recorded.into(), computed: computed.into() };
            unrecorded(&difference).map(|missing| missing.into_iter().collect::<Vec<_>>())
        };
        let now = r#"{"event":"tethered","length_m":1.5,"measured":{"pull_n":2.0},"bends":[{"x":1,"on":"C1"},{"x":2}]}"#;
        let missing = |keys: &[&str]| Some(keys.iter().map(|key| (*key).to_owned()).collect::<Vec<_>>());
        let before = r#"{"event":"tethered","length_m":1.5,"bends":[{"x":1},{"x":2}]}"#;
        assert_eq!(lacks(before, now), missing(&["tethered.bends.on", "tethered.measured"]));
        let others = [
            now,
            r#"{"event":"tethered","length_m":1.6,"bends":[{"x":1},{"x":2}]}"#,
            r#"{"event":"tethered","length_m":1.5,"bends":[{"x":1}]}"#,
            r#"{"event":"tethered","length_m":1.5,"bends":[{"x":1},{"x":2}],"older":1}"#,
            r#"{"event":"planned","length_m":1.5,"bends":[{"x":1},{"x":2}]}"#,
            "nothing more in this tick",
        ];
        for other in others {
            assert_eq!(lacks(other, now), None, "{other}");
        }
        assert_eq!(lacks(&now.replace(",\"bends", ", \"bends"), now), None, "only spelt differently");
    }

    #[test]
    fn a_difference_far_inside_a_long_text_is_shown() {
        let toml = "name = 1\\n".repeat(500);
        let event = |radius: &str| {
            format!("{{\"event\":\"run_opened\",\"scenario_toml\":\"{toml}radius = {radius}\\n{toml}\"}}")
        };
        let text = said(&event("5.25"), &event("6.25"));
        assert!(text.contains("scenario_toml") && text.contains("5.25") && text.contains("6.25"), "{text}");
    }
}
