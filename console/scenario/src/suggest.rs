//! Suggests a correction for an unknown key.

use super::schema::{Key, sections};
use mission::spelling::nearest;

/// Units in which people write values: the suffix of the key, the scenario's unit, and the conversion factor.
const UNITS: &[(&str, &str, f64)] = &[
    ("_m_per_s2", "m/s²", 1.0),
    ("_cm_per_s", "m/s", 0.01),
    ("_mm_per_s", "m/s", 0.001),
    ("_km_per_h", "m/s", 1.0 / 3.6),
    ("_rad_per_s", "deg/s", 180.0 / std::f64::consts::PI),
    ("_deg_per_s", "deg/s", 1.0),
    ("_m_per_s", "m/s", 1.0),
    ("_kmh", "m/s", 1.0 / 3.6),
    ("_kph", "m/s", 1.0 / 3.6),
    ("_mph", "m/s", 0.447_04),
    ("_mps", "m/s", 1.0),
    ("_rpm", "deg/s", 6.0),
    ("_degrees", "deg", 1.0),
    ("_radians", "deg", 180.0 / std::f64::consts::PI),
    ("_rad", "deg", 180.0 / std::f64::consts::PI),
    ("_deg", "deg", 1.0),
    ("_metres", "m", 1.0),
    ("_meters", "m", 1.0),
    ("_inch", "m", 0.0254),
    ("_feet", "m", 0.3048),
    ("_ft", "m", 0.3048),
    ("_in", "m", 0.0254),
    ("_km", "m", 1000.0),
    ("_cm", "m", 0.01),
    ("_mm", "m", 0.001),
    ("_m", "m", 1.0),
    ("_minutes", "s", 60.0),
    ("_seconds", "s", 1.0),
    ("_hours", "s", 3600.0),
    ("_min", "s", 60.0),
    ("_sec", "s", 1.0),
    ("_ms", "s", 0.001),
    ("_h", "s", 3600.0),
    ("_s", "s", 1.0),
];

/// The suggested correction: the right unit, the nearest name, the right section, or a list of all names.
pub(crate) fn remedy(section: &str, keys: &'static [Key], unknown: &str, value: Option<f64>) -> String {
    // Names are compared letter by letter, so very long names are shortened; they cannot be misspellings of known keys.
    let short: String = unknown.chars().take(64).collect();
    same_quantity(keys, &short, value)
        .or_else(|| {
            nearest(&short, keys.iter().map(|key| key.name)).map(|name| format!("did you mean `{name}`?"))
        })
        .or_else(|| elsewhere(&short))
        .unwrap_or_else(|| all_names(section, keys))
}

/// The same quantity with a different unit, or without one.
fn same_quantity(keys: &[Key], unknown: &str, value: Option<f64>) -> Option<String> {
    let (stem, unit) = split_unit(unknown);
    let right = keys.iter().find(|key| !key.unit.is_empty() && split_unit(key.name).0 == stem)?;
    let converted = match (unit, value) {
        (Some((unit, factor)), Some(value)) if unit == right.unit && (factor - 1.0).abs() > 0.0 => {
            format!(": write {} = {}", right.name, rounded(value * factor))
        }
        _ => String::new(),
    };
    Some(format!("the key is `{}`, in {}{converted}", right.name, right.unit))
}

fn split_unit(name: &str) -> (&str, Option<(&'static str, f64)>) {
    UNITS
        .iter()
        .find_map(|(suffix, unit, factor)| Some((name.strip_suffix(suffix)?, Some((*unit, *factor)))))
        .unwrap_or((name, None))
}

fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// The section that has a key with exactly this name.
fn elsewhere(unknown: &str) -> Option<String> {
    let (path, _) = sections().into_iter().find(|(_, keys)| keys.iter().any(|key| key.name == unknown))?;
    let place = if path.is_empty() { "the top of the file".to_owned() } else { format!("[{path}]") };
    Some(format!("`{unknown}` belongs in {place}"))
}

fn all_names(section: &str, keys: &[Key]) -> String {
    let names: Vec<&str> = keys.iter().map(|key| key.name).collect();
    let place = if section.is_empty() { "a scenario".to_owned() } else { format!("[{section}]") };
    format!("the keys of {place} are {}", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(path: &str) -> &'static [Key] {
        sections().into_iter().find(|(name, _)| name == path).expect("a section").1
    }

    #[test]
    fn another_unit_is_converted() {
        assert_eq!(
            remedy("tank", keys("tank"), "radius_cm", Some(500.0)),
            "the key is `radius_m`, in m: write radius_m = 5"
        );
        assert_eq!(
            remedy("robot", keys("robot"), "speed_max_kmh", Some(3.6)),
            "the key is `speed_max_m_per_s`, in m/s: write speed_max_m_per_s = 1"
        );
    }

    #[test]
    fn a_missing_unit_is_named() {
        assert_eq!(remedy("ae", keys("ae"), "period", Some(1.0)), "the key is `period_s`, in s");
    }

    #[test]
    fn a_misspelt_key_gets_the_nearest_one() {
        assert_eq!(remedy("ae", keys("ae"), "repititions", None), "did you mean `repetitions`?");
        assert_eq!(remedy("", keys(""), "obstacle", None), "did you mean `obstacles`?");
    }

    #[test]
    fn a_key_of_another_section_is_sent_there() {
        assert_eq!(remedy("robot", keys("robot"), "swath_m", None), "`swath_m` belongs in [mission]");
    }

    #[test]
    fn a_section_of_the_future_gets_the_list() {
        let list = remedy("", keys(""), "winch", None);
        assert!(list.starts_with("the keys of a scenario are name, about, seed, "), "{list}");
        assert!(list.contains(", tank, "), "{list}");
    }
}
