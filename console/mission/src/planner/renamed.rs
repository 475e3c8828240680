//! Parameters of planners that had other names in earlier versions.

/// Planner, old name and today's name of each parameter that was renamed.
const RENAMED: &[(&str, &str, &str)] = &[
    ("tether-safe", "sum_wrap_deg", "wrap_total_deg"),
    ("apf-dwa", "land_speed_m_per_s", "land_speed_max_m_per_s"),
    ("apf-dwa", "underwater_speed_m_per_s", "underwater_speed_max_m_per_s"),
];

/// Today's name of a parameter of a planner; `None` if it was not renamed.
///
/// ```
/// assert_eq!(mission::todays_parameter("tether-safe", "sum_wrap_deg"), Some("wrap_total_deg"));
/// assert_eq!(mission::todays_parameter("navfn", "sum_wrap_deg"), None);
/// ```
pub fn todays_parameter(planner: &str, old: &str) -> Option<&'static str> {
    RENAMED.iter().find(|(id, name, _)| (*id, *name) == (planner, old)).map(|(.., new)| *new)
}
