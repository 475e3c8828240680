//! Reads the bounds on the run's results: `[expect]`.

use super::section::Section;
use account::Expect;
use mission::Outcome;

/// The bounds on figures of a scan or of a preset path, which a survey does not have.
const NOT_IN_A_SURVEY: [&str; 8] = [
    "coverage_reachable_min",
    "coverage_truth_min",
    "coverage_whole_min",
    "overlap_max",
    "precision_min",
    "recall_min",
    "rmse_max_m",
    "cross_track_rmse_max_m",
];

/// Reads `[expect]`; without this section there are no bounds.
pub(crate) fn expect(root: &Section<'_>, is_survey: bool) -> Option<Expect> {
    let section = root.table_or_empty("expect")?;
    if is_survey {
        section.refuse(
            &NOT_IN_A_SURVEY,
            "mission.kind = \"survey\", because a survey does not have this figure",
        );
    } else {
        section.refuse(&["explored_min"], "a mission that is not a survey, because it makes no map");
    }
    let outcome = section.word("outcome").map(|word| match word {
        "complete" => Outcome::Complete,
        "stuck" => Outcome::Stuck,
        "collision" => Outcome::Collision,
        "time_limit" => Outcome::TimeLimit,
        "entangled" => Outcome::Entangled,
        _ => Outcome::Aborted,
    });
    Some(Expect {
        outcome,
        collisions_max: section.whole("collisions_max").map(|n| n as u64),
        clearance_min_m: section.number("clearance_min_m"),
        mission_time_max_s: section.number("mission_time_max_s"),
        path_length_max_m: section.number("path_length_max_m"),
        coverage_reachable_min: section.number("coverage_reachable_min"),
        coverage_truth_min: section.number("coverage_truth_min"),
        coverage_whole_min: section.number("coverage_whole_min"),
        explored_min: section.number("explored_min"),
        overlap_max: section.number("overlap_max"),
        precision_min: section.number("precision_min"),
        recall_min: section.number("recall_min"),
        rmse_max_m: section.number("rmse_max_m"),
        cross_track_rmse_max_m: section.number("cross_track_rmse_max_m"),
        mean_error_max_m: section.number("mean_error_max_m"),
        p95_error_max_m: section.number("p95_error_max_m"),
        in_95_ellipse_min: section.number("in_95_ellipse_min"),
        position_lost_max_s: section.number("position_lost_max_s"),
        tether_length_max_m: section.number("tether_length_max_m"),
        wrap_max_rad: section.number("wrap_max_deg").map(f64::to_radians),
        tether_end_length_max_m: section.number("tether_end_length_max_m"),
    })
}
