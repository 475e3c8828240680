//! Rows of one planner in one kind of tank.

use super::{Measured, cover::Covered, survey::Surveyed};
use crate::study::{Block, Row, Sample};

/// A figure: its id, its unit and its value.
type Figure<T> = (&'static str, &'static str, fn(&T) -> f64);

const OF_SURVEY: &[Figure<Surveyed>] = &[
    ("survey_explored", "", |survey| survey.explored),
    ("survey_unreal_objects", "", |survey| survey.unreal as f64),
    ("survey_collisions", "", |survey| survey.collisions as f64),
    ("survey_clearance_min_m", "m", |survey| survey.clearance_m),
    ("survey_time_s", "s", |survey| survey.time_s),
    ("survey_path_m", "m", |survey| survey.path_m),
];

const OF_COVER: &[Figure<Covered>] = &[
    ("coverage_truth", "", |cover| cover.scanned[0]),
    ("coverage_reachable", "", |cover| cover.scanned[1]),
    ("collisions", "", |cover| cover.collisions as f64),
    ("clearance_min_m", "m", |cover| cover.clearance_m),
    ("obstacles_found", "", |cover| cover.found as f64),
    ("time_s", "s", |cover| cover.time_s),
    ("path_m", "m", |cover| cover.path_m),
    ("tether_length_max_m", "m", |cover| cover.tether_m[0]),
    ("tether_end_length_m", "m", |cover| cover.tether_m[1]),
    ("wrap_max_deg", "deg", |cover| cover.wrap_rad.to_degrees()),
];

/// The rows for the results in the tanks of these seeds; tanks without a result are named with the reason.
pub(super) fn rows(block: &Block<'_>, all: &[(u64, &Measured)]) -> Vec<Row> {
    let surveys: Vec<(u64, &Surveyed)> =
        all.iter().filter_map(|(seed, one)| Some((*seed, one.survey.as_ref()?))).collect();
    let mut rows = Vec::new();
    if !surveys.is_empty() {
        let end = |survey: &Surveyed| survey.end.clone().err();
        rows.push(rate(block, "survey_complete_rate", &surveys, end));
        let [columns, found] = surveys.iter().fold([0, 0], |sum: [usize; 2], (_, survey)| {
            [sum[0] + survey.columns[0], sum[1] + survey.columns[1]]
        });
        rows.push(block.row("survey_column_rate", found as f64 / columns.max(1) as f64, "", columns));
        for (index, metric) in
            ["survey_center_error_max_m", "survey_radius_error_max_m"].into_iter().enumerate()
        {
            let errors = surveys.iter().filter_map(|(_, survey)| survey.errors_m.map(|errors| errors[index]));
            rows.push(block.row(metric, errors.reduce(f64::max), "m", found));
        }
        rows.extend(OF_SURVEY.iter().map(|figure| mean(block, figure, &surveys)));
    }
    let why = |one: &Measured| match &one.cover {
        Ok(cover) => cover.unfinished.clone(),
        Err(reason) => Some(reason.clone()),
    };
    rows.push(rate(block, "complete_rate", all, why));
    let covers: Vec<(u64, &Covered)> =
        all.iter().filter_map(|(seed, one)| Some((*seed, one.cover.as_ref().ok()?))).collect();
    rows.extend(OF_COVER.iter().map(|figure| mean(block, figure, &covers)));
    rows
}

/// The share of the results without a reason against it; the reasons are the note.
fn rate<T>(block: &Block<'_>, metric: &str, all: &[(u64, &T)], why: impl Fn(&T) -> Option<String>) -> Row {
    let missed: Vec<String> =
        all.iter().filter_map(|(seed, one)| Some(format!("seed {seed} ({})", why(one)?))).collect();
    let share = 1.0 - missed.len() as f64 / all.len().max(1) as f64;
    block.row(metric, share, "", all.len()).note(missed.join("; "))
}

fn mean<T>(block: &Block<'_>, (metric, unit, of): &Figure<T>, all: &[(u64, &T)]) -> Row {
    let values: Sample = all.iter().map(|(_, one)| of(one)).collect();
    block.row(metric, values.mean(), unit, values.len())
}
