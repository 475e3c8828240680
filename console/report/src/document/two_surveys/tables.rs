//! The comparison as tables for spreadsheets.

use super::TwoSurveys;
use crate::document::csv::table;
use surveys::{Growth, Indication, SIGMAS_95};

/// Suffixes of the file names, in the order of [`two_surveys_tables`].
pub const TWO_SURVEYS_SUFFIXES: [&str; 2] = ["", "-plates"];

/// The indications of both surveys, and the rates of the plates. A value that does not exist is an empty cell.
pub fn two_surveys_tables(comparison: &TwoSurveys) -> [String; TWO_SURVEYS_SUFFIXES.len()] {
    [indications(comparison), plates(comparison)]
}

/// Number, place, depth and 95 % error of an indication; empty cells without one.
fn cells(one: Option<&Indication>) -> Vec<String> {
    let Some(one) = one else { return vec![String::new(); 5] };
    let values = [one.at.x, one.at.y, one.depth_mm, SIGMAS_95 * one.depth_sigma_mm];
    std::iter::once(one.number.to_string()).chain(values.map(|value| format!("{value:.3}"))).collect()
}

/// Growth and rate, each with the ends of its 95 % interval; empty cells without a growth.
fn grown(growth: Option<&Growth>) -> Vec<String> {
    let Some(growth) = growth else { return vec![String::new(); 6] };
    let ([low, high], [slow, fast]) = (growth.interval_mm, growth.rate_interval_mm_per_a);
    [growth.mm, low, high, growth.rate_mm_per_a, slow, fast].map(|value| format!("{value:.3}")).to_vec()
}

fn yes(is: bool) -> String {
    if is { "yes" } else { "no" }.into()
}

fn indications(comparison: &TwoSurveys) -> String {
    let plate = |one: &Indication| one.plate.clone().unwrap_or_default();
    let matched = comparison.matched.iter().map(|pair| {
        let mut row = vec!["both".to_owned(), plate(&pair.second)];
        row.extend([Some(&pair.first), Some(&pair.second)].into_iter().flat_map(cells));
        row.extend([format!("{:.3}", pair.apart_m), pair.rivals.to_string()]);
        row.extend(grown(Some(&pair.growth)));
        row.extend(["yes".into(), yes(pair.is_cut), String::new()]);
        row
    });
    let single = |state: &str, one: &super::Single, is_first: bool| {
        let indication = &one.indication;
        let sides = if is_first { [Some(indication), None] } else { [None, Some(indication)] };
        let mut row = vec![state.to_owned(), plate(indication)];
        row.extend(sides.into_iter().flat_map(cells));
        row.extend([String::new(), String::new()]);
        row.extend(grown(None));
        row.extend([yes(one.is_tested), yes(indication.is_cut)]);
        row.push(one.part_of.map_or_else(String::new, |number| number.to_string()));
        row
    };
    let new = comparison.new.iter().map(|one| single("new", one, false));
    let gone = comparison.gone.iter().map(|one| single("gone", one, true));
    let head = [
        "state",
        "plate",
        "first_number",
        "first_x_m",
        "first_y_m",
        "first_depth_mm",
        "first_depth_error_95_mm",
        "second_number",
        "second_x_m",
        "second_y_m",
        "second_depth_mm",
        "second_depth_error_95_mm",
        "apart_m",
        "rivals",
        "growth_mm",
        "growth_low_mm",
        "growth_high_mm",
        "rate_mm_per_a",
        "rate_low_mm_per_a",
        "rate_high_mm_per_a",
        "tested_by_both",
        "cut_by_untested",
        "part_of_number",
    ];
    table(&head, matched.chain(new).chain(gone))
}

fn plates(comparison: &TwoSurveys) -> String {
    let rows = comparison.plates.iter().map(|plate| {
        let mut row = vec![plate.plate.clone()];
        row.extend([plate.matched, plate.new, plate.gone].map(|count| count.to_string()));
        for growth in [&plate.mean, &plate.greatest] {
            row.extend(grown(growth.as_ref()).into_iter().skip(3));
        }
        row
    });
    let head = [
        "plate",
        "both",
        "new",
        "gone",
        "mean_rate_mm_per_a",
        "mean_rate_low_mm_per_a",
        "mean_rate_high_mm_per_a",
        "greatest_rate_mm_per_a",
        "greatest_rate_low_mm_per_a",
        "greatest_rate_high_mm_per_a",
    ];
    table(&head, rows)
}
