//! Keys that had other names in earlier versions.

use mission::todays_parameter;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// Section, old name and today's name of each key that was renamed after 0.1.0.
const RENAMED: &[(&str, &str, &str)] = &[
    ("robot", "turn_max_deg_per_s", "turn_rate_max_deg_per_s"),
    ("robot", "land_speed_m_per_s", "land_speed_max_m_per_s"),
    ("robot", "land_turn_deg_per_s", "land_turn_rate_max_deg_per_s"),
    ("robot", "underwater_speed_m_per_s", "underwater_speed_max_m_per_s"),
    ("robot", "underwater_turn_deg_per_s", "underwater_turn_rate_max_deg_per_s"),
    ("ae", "dropout", "dropout_probability"),
    ("ae", "ping_dropout", "ping_dropout_probability"),
    ("ae", "outlier_chance", "outlier_probability"),
    ("ae", "nlos_chance", "nlos_probability"),
    ("ae", "late_ping_chance", "late_ping_probability"),
    ("ae", "late_mean_m", "excess_range_mean_m"),
    ("ae", "calibrates_sound", "calibrate_sound_speed"),
    ("ae.faults", "late_m", "excess_range_m"),
    ("tether", "reel_m", "reel_length_m"),
    ("tether", "max_wrap_deg", "wrap_max_deg"),
    ("tether", "max_sum_wrap_deg", "wrap_total_max_deg"),
    ("tether", "fly_uncertified", "allow_uncertified"),
    ("mission", "lost_hold_s", "position_lost_hold_s"),
    ("expect", "min_clearance_min_m", "clearance_min_m"),
    ("expect", "lost_max_s", "position_lost_max_s"),
    ("expect", "cable_max_m", "tether_length_max_m"),
    ("expect", "left_out_max_m", "tether_end_length_max_m"),
];

/// Where a scenario sets parameters of planners.
const PARAMETER_SECTIONS: [&str; 2] = ["planner.parameters", "planner.fallback.parameters"];

/// Today's name of a key of a section that was renamed.
pub(crate) fn todays_name(section: &str, old: &str) -> Option<&'static str> {
    renamed_keys(section).find(|(name, _)| *name == old).map(|(_, new)| new)
}

/// Old and today's names of the keys of a section; `section` is a path as messages show it, such as `ae.faults.2`.
pub(crate) fn renamed_keys(section: &str) -> impl Iterator<Item = (&'static str, &'static str)> {
    let section = section.trim_end_matches(|c: char| c == '.' || c.is_ascii_digit());
    RENAMED.iter().filter(move |(place, ..)| *place == section).map(|(_, old, new)| (*old, *new))
}

/// A scenario's text with today's keys, for the scenarios in old journals; a text that is not TOML stays as it is.
pub fn with_todays_keys(text: &str) -> String {
    let Ok(table) = DeTable::parse(text) else { return text.to_owned() };
    let mut old = old_keys("", "", table.get_ref());
    old.sort_by_key(|(at, _)| at.start);
    let mut text = text.to_owned();
    // From the end, so that the places before stay true.
    for (at, new) in old.into_iter().rev() {
        text.replace_range(at, new);
    }
    text
}

/// The bytes of every old key of a section and of the sections in it, with its name today; `planner` is the id that the
/// section around it names.
fn old_keys(section: &str, planner: &str, table: &DeTable<'_>) -> Vec<(Range<usize>, &'static str)> {
    let is_of_planner = PARAMETER_SECTIONS.contains(&section);
    let id = table.get("id").and_then(|id| id.get_ref().as_str()).unwrap_or_default();
    let mut found = Vec::new();
    for (key, value) in table {
        let name: &str = key.get_ref();
        let todays = if is_of_planner { todays_parameter(planner, name) } else { todays_name(section, name) };
        found.extend(todays.map(|new| (key.span(), new)));
        let inner = if section.is_empty() { name.to_owned() } else { format!("{section}.{name}") };
        let tables = tables_of(value.get_ref());
        found.extend(tables.into_iter().flat_map(|table| old_keys(&inner, id, table)));
    }
    found
}

/// The tables that a value is or lists.
fn tables_of<'a, 'i>(value: &'a DeValue<'i>) -> Vec<&'a DeTable<'i>> {
    match value {
        DeValue::Array(list) => list.iter().filter_map(|entry| entry.get_ref().as_table()).collect(),
        one => one.as_table().into_iter().collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::sections;

    #[test]
    fn every_new_name_is_a_key_and_no_old_name_is() {
        for (section, old, new) in RENAMED {
            let keys = sections().into_iter().find(|(path, _)| path == section).expect("a section").1;
            assert!(keys.iter().any(|key| key.name == *new), "{section}.{new}");
            assert!(!keys.iter().any(|key| key.name == *old), "{section}.{old}");
        }
    }

    #[test]
    fn old_keys_become_todays_wherever_they_stand() {
        let new =
            |old: &str, keys: [&str; 2]| assert_eq!(with_todays_keys(old), old.replace(keys[0], keys[1]));
        let rest = "\nreel_length = 1 # kept\nfriction = 0.3\n";
        new(&format!("[tether]\n# the reel\nreel_m = 3{rest}"), ["reel_m", "reel_length_m"]);
        new("tether.reel_m = 3\ntether.friction = 0.3", ["reel_m", "reel_length_m"]);
        new("[[ae.faults]]\nlate_m = 2.0\nkind = 1\n[[ae.faults]]\nlate_m = 1", ["late_m", "excess_range_m"]);
        new("ae = { dropout = 0.1, period_s = 1 }", ["dropout", "dropout_probability"]);
        assert_eq!(
            with_todays_keys("[tether]\n\"reel_m\" = 3").replace('"', ""),
            "[tether]\nreel_length_m = 3"
        );
        assert_eq!(with_todays_keys("not = toml ["), "not = toml [");
    }

    #[test]
    fn old_parameters_become_todays_of_their_own_planner_only() {
        let planners = |id: &str, fallback: &str, keys: [&str; 2]| {
            format!(
                "[planner]\nid = \"{id}\"\nparameters = {{ {} = 9, wrap_deg = 8 }}\n\
                 [planner.fallback]\nparameters.{} = 9\nid = \"{fallback}\"\n",
                keys[0], keys[1]
            )
        };
        let todays = |id, fallback| with_todays_keys(&planners(id, fallback, ["sum_wrap_deg"; 2]));
        let (safe, other, new) = ("tether-safe", "navfn", "wrap_total_deg");
        assert_eq!(todays(safe, other), planners(safe, other, [new, "sum_wrap_deg"]));
        assert_eq!(todays(other, safe), planners(other, safe, ["sum_wrap_deg", new]));
    }
}
