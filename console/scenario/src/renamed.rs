//! Keys that had other names in earlier versions.

use toml_edit::{DocumentMut, Item, Key, TableLike};

/// Section, old name and today's name of each key that was renamed before 0.1.0 was finished.
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

/// The same for parameters of planners, wherever a scenario sets them.
const PARAMETERS: &[(&str, &str)] = &[
    ("sum_wrap_deg", "wrap_total_deg"),
    ("land_speed_m_per_s", "land_speed_max_m_per_s"),
    ("underwater_speed_m_per_s", "underwater_speed_max_m_per_s"),
];

/// Where a scenario sets parameters of planners.
const PARAMETER_SECTIONS: [&str; 2] = ["planner.parameters", "planner.fallback.parameters"];

/// Today's name of a key of a section; `section` is a path as messages show it, such as `ae.faults.2`.
pub(crate) fn todays_name(section: &str, old: &str) -> Option<&'static str> {
    let section = section.trim_end_matches(|c: char| c == '.' || c.is_ascii_digit());
    RENAMED.iter().find(|(place, name, _)| (*place, *name) == (section, old)).map(|(.., new)| *new)
}

/// A scenario's text with today's keys, for the scenarios in old journals; a text that is no TOML stays as it is.
pub fn with_todays_keys(text: &str) -> String {
    let Ok(mut document) = text.parse::<DocumentMut>() else { return text.to_owned() };
    let of_planner = |section| PARAMETERS.iter().map(move |(old, new)| (section, *old, *new));
    let of_planners = PARAMETER_SECTIONS.into_iter().flat_map(of_planner);
    for (section, old, new) in RENAMED.iter().copied().chain(of_planners) {
        let mut tables: Vec<&mut dyn TableLike> = vec![document.as_table_mut()];
        for part in section.split('.') {
            tables = tables.into_iter().filter_map(|table| table.get_mut(part)).flat_map(tables_of).collect();
        }
        for table in tables {
            // The comments before a key are part of it.
            let key = table.key(old).map(|key| Key::new(new).with_leaf_decor(key.leaf_decor().clone()));
            if let (Some(key), Some(item)) = (key, table.remove(old)) {
                table.entry_format(&key).or_insert(item);
            }
        }
    }
    document.to_string()
}

/// The tables that an item is or holds.
fn tables_of(item: &mut Item) -> Vec<&mut dyn TableLike> {
    match item {
        Item::ArrayOfTables(all) => all.iter_mut().map(|table| table as &mut dyn TableLike).collect(),
        Item::Value(toml_edit::Value::Array(all)) => {
            let inline = all.iter_mut().filter_map(toml_edit::Value::as_inline_table_mut);
            inline.map(|table| table as &mut dyn TableLike).collect()
        }
        one => one.as_table_like_mut().into_iter().collect(),
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
        let old = "[tether]\n# the reel\nreel_m = 3\n[[ae.faults]]\nstation = \"S1\"\nlate_m = 2.0\n";
        let new = with_todays_keys(old);
        assert!(
            new.contains("# the reel\nreel_length_m = 3") && new.contains("excess_range_m = 2.0"),
            "{new}"
        );
        let old = "[planner]\nfallback = { parameters = { sum_wrap_deg = 9 } }\n";
        assert!(with_todays_keys(old).contains("wrap_total_deg = 9"), "{}", with_todays_keys(old));
        assert!(with_todays_keys("ae = { dropout = 0.1 }").contains("dropout_probability = 0.1"));
        assert_eq!(with_todays_keys("not = toml ["), "not = toml [");
    }
}
