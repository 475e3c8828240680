//! The meanings and units of a table's columns; stored with each column in the file.

use arrow::datatypes::Field;
use std::collections::HashMap;

/// Meaning of each column, by name; the unit is determined by the name.
const MEANINGS: [(&str, &str); 58] = [
    ("case", "number of the mission; seeds are outermost"),
    ("scenario", "name of the scenario"),
    ("planner", "id of the planner that was active first"),
    ("seed", "seed for all random choices"),
    ("status", "flown, refused or failed"),
    ("error", "why the mission did not run"),
    ("success", "complete, and every bound met"),
    ("outcome", "outcome of the mission"),
    ("reason", "reason for the outcome, as a sentence"),
    ("violations", "bounds that were not met, as sentences"),
    ("planner_version", "version of the planner's plugin"),
    ("parameters", "parameters of the planner, defaults included, as JSON"),
    ("ticks", "number of ticks"),
    ("mission_time_s", "mission time until the end, whatever the outcome"),
    ("path_length_m", "true distance driven by the robot"),
    ("turns", "number of heading changes of more than 30 degrees within half a metre"),
    ("rotation_turns", "sum of the true heading changes, in whole turns"),
    ("clearance_min_m", "smallest true distance from the hull to anything solid; negative after a collision"),
    ("collisions", "number of times the hull came into contact with something"),
    ("obstacles_found", "number of obstacles found that were not on the drawing"),
    ("holds", "number of times the robot was held"),
    ("planner_faults", "number of times a planner failed"),
    ("coverage.reachable", "scanned share of the reachable floor, according to the estimated path"),
    ("coverage.whole", "scanned share of the whole floor, according to the estimated path"),
    ("coverage.overlap", "share of the scanned floor that was scanned more than once"),
    ("coverage.missed_area_m2", "reachable floor that was not scanned"),
    ("coverage.by_truth.reachable", "scanned share of the reachable floor, according to the true path"),
    ("coverage.by_truth.whole", "scanned share of the whole floor, according to the true path"),
    ("coverage.by_truth.scanned_truly", "share of the floor claimed as scanned that was actually scanned"),
    (
        "coverage.by_truth.guaranteed_truly",
        "share of the floor claimed as guaranteed that was actually scanned",
    ),
    ("tracking.precision", "share of the true path within 0.2 m of the preset path"),
    ("tracking.recall", "share of the preset points within 0.2 m of the true path"),
    ("tracking.rmse_m", "root mean square distance from the preset points to the true path"),
    ("tracking.cross_track_rmse_m", "root mean square distance from the true path to the preset path"),
    ("accuracy.mean_m", "mean 95 % error of the position, from its covariance"),
    ("accuracy.p95_m", "95 % error of the position, from its covariance, not exceeded in 95 % of the ticks"),
    ("accuracy.max_m", "maximum 95 % error of the position, from its covariance"),
    ("accuracy.over_limit", "share of the distance driven while the 95 % error was above the limit"),
    ("accuracy.fixes", "number of positions computed from ranges"),
    ("accuracy.stations_mean", "mean number of stations used for a fix"),
    ("accuracy.stations_min", "minimum number of stations used for a fix"),
    ("positioning.mean_error_m", "mean distance from the estimated to the true position"),
    ("positioning.p50_m", "median distance from the estimated to the true position"),
    (
        "positioning.p95_m",
        "distance from the estimated to the true position, not exceeded in 95 % of the ticks",
    ),
    ("positioning.max_m", "maximum distance from the estimated to the true position"),
    ("positioning.in_95_ellipse", "share of the ticks in which the 95 % ellipse contained the true position"),
    ("positioning.position_lost_s", "total time during which the position was lost"),
    ("tether.tether_length_max_m", "maximum length of tether out"),
    ("tether.wrap_max_rad", "maximum angle by which the cable bends round one obstacle"),
    ("tether.wrap_total_max_rad", "maximum sum of the angles by which the cable bends round all obstacles"),
    ("tether.loops", "number of loops in the tether at the end"),
    ("tether.end_length_m", "length of tether out at the end"),
    (
        "tether.entangled",
        "whether the tether ended the mission, or was still out when the robot was back at the anchor",
    ),
    ("tether.snags", "number of times the mission detected a snagged tether"),
    ("tether.snagged", "whether the tether was snagged when the run ended"),
    ("scenario_sha256", "SHA-256 of the scenario's text"),
    (
        "readings.detected",
        "probability of detection: share of the tested true losses of at least a fifth of the thickness that are in an \
         indication",
    ),
    ("readings.false_calls", "number of indications where no metal is lost"),
];

/// Units by the ending of a column's name.
const UNITS: [(&str, &str); 6] =
    [("_m_per_s", "m/s"), ("_m2", "m²"), ("_m", "m"), ("_s", "s"), ("_rad", "rad"), ("_deg", "deg")];

/// Columns that contain shares from 0 to 1.
const SHARES: [&str; 6] = ["reachable", "whole", "overlap", "precision", "recall", "over_limit"];

/// The meaning of a column; `None` if the column is unknown.
pub(crate) fn meaning(name: &str) -> Option<&'static str> {
    MEANINGS.iter().find(|(known, _)| *known == name).map(|(_, meaning)| *meaning)
}

/// The unit of a column: `1` for shares and counts, empty if the column is not numeric.
pub(crate) fn unit(name: &str, is_number: bool) -> &'static str {
    if !is_number {
        return "";
    }
    let is_share = |end: &&&str| name.rsplit('.').next() == Some(**end) || name.ends_with("_truly");
    let of_name = UNITS.iter().find(|(end, _)| name.ends_with(end)).map(|(_, unit)| *unit);
    of_name.or_else(|| SHARES.iter().find(is_share).map(|_| "share from 0 to 1")).unwrap_or("1")
}

/// A column, with its unit and meaning.
pub(crate) fn explained(field: Field) -> Field {
    let name = field.name().clone();
    let of_grid = name.strip_prefix("set.").map(|key| format!("value of {key} in this mission"));
    let meaning = of_grid.or_else(|| meaning(&name).map(str::to_owned)).unwrap_or_default();
    let unit = unit(&name, field.data_type().is_numeric()).to_owned();
    // The entries of a map are stored in the order of their names.
    field.with_metadata(HashMap::from([("meaning".to_owned(), meaning), ("unit".to_owned(), unit)]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_follow_from_names() {
        assert_eq!(unit("mission_time_s", true), "s");
        assert_eq!(unit("coverage.missed_area_m2", true), "m²");
        assert_eq!(unit("set.robot.speed_max_m_per_s", true), "m/s");
        assert_eq!(unit("coverage.by_truth.scanned_truly", true), "share from 0 to 1");
        assert_eq!(unit("turns", true), "1");
        assert_eq!(unit("reason", false), "");
    }
}
