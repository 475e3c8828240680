//! Rows of one planner at one ratio.

use super::{
    Measured,
    drive::{Drive, Home},
    reeling::Reeling,
};
use crate::study::{Block, Row, Sample};

/// Length of cable beyond the taut line up to which the certificate holds: metres, or a share of the longest taut line if
/// this is more. The share is 1.5 times the sag of a straight cable that is dragged at a ratio of 0.8.
const MARGIN_M: f64 = 0.3;
const MARGIN_SHARE: f64 = 0.04;

/// The rows for the results in the tanks of these seeds. Tanks without a path are named.
pub(super) fn rows(block: &Block<'_>, all: &[(u64, &Measured)]) -> Vec<Row> {
    let mut drives = Vec::new();
    let mut pulls = Vec::new();
    let mut without = Vec::new();
    for (seed, measured) in all {
        match measured {
            Measured::Drive(drive) => drives.push((*seed, drive)),
            Measured::Reeling(found) => pulls.extend(found.iter().map(|reeling| (*seed, reeling))),
            Measured::NoPath(reason) => without.push(format!("seed {seed} ({reason})")),
        }
    }
    let path_rate = 1.0 - without.len() as f64 / all.len().max(1) as f64;
    let mut rows = vec![block.row("path_rate", path_rate, "", all.len()).note(without.join("; "))];
    if !drives.is_empty() {
        rows.extend(of_drives(block, &drives));
    }
    if !pulls.is_empty() {
        rows.extend(of_pulls(block, &pulls));
    }
    rows
}

fn of_drives(block: &Block<'_>, drives: &[(u64, &Drive)]) -> Vec<Row> {
    let rate = |metric: &str, of: Vec<bool>| {
        let share = of.iter().filter(|is| **is).count() as f64 / of.len().max(1) as f64;
        block.row(metric, (!of.is_empty()).then_some(share), "", of.len())
    };
    let each = |is: fn(&Drive) -> bool| drives.iter().map(|(_, drive)| is(drive)).collect();
    let over: Vec<&Drive> =
        drives.iter().map(|(_, drive)| *drive).filter(|drive| drive.times_over > 0).collect();
    let mut rows = vec![rate("within_margin_rate", each(|drive| drive.excess_max_m <= margin_m(drive)))];
    rows.extend(worst(block, "excess_share", "", drives, |drive| {
        drive.excess_max_m / drive.longest_m.max(1e-9)
    }));
    rows.extend(worst(block, "excess_m", "m", drives, |drive| drive.excess_max_m));
    rows.extend(worst(block, "times_over_own_cable", "", drives, |drive| drive.times_over as f64));
    rows.extend(worst(block, "snag_alarms", "", drives, |drive| drive.snags as f64));
    rows.extend(worst(block, "end_excess_m", "m", drives, |drive| drive.end_excess_m));
    rows.push(rate("slack_hold_rate", each(|drive| drive.is_held)));
    rows.push(rate(
        "held_before_own_cable_rate",
        over.iter().map(|drive| drive.is_held && drive.times_over_before_hold == 0).collect(),
    ));
    rows.push(rate("freed_rate", drives.iter().filter_map(|(_, drive)| drive.is_freed).collect()));
    let ends =
        |wanted: Home| drives.iter().filter_map(|(_, drive)| drive.home).map(|home| home == wanted).collect();
    rows.push(rate("home_refused_rate", ends(Home::Refused)));
    rows.push(rate("home_held_rate", ends(Home::Held)));
    rows.push(rate("home_rate", ends(Home::There)));
    let homes: Vec<(u64, &(usize, usize))> =
        drives.iter().filter_map(|(seed, drive)| Some((*seed, drive.times_over_home.as_ref()?))).collect();
    if !homes.is_empty() {
        rows.push(rate(
            "home_without_own_cable_rate",
            homes.iter().map(|(_, (times, _))| *times == 0).collect(),
        ));
        rows.push(rate("same_on_taut_line_rate", homes.iter().map(|(_, (_, times))| *times == 0).collect()));
        rows.extend(worst(block, "times_over_home", "", &homes, |(times, _)| *times as f64));
        rows.extend(worst(block, "times_over_home_on_taut_line", "", &homes, |(_, times)| *times as f64));
    }
    rows
}

fn margin_m(drive: &Drive) -> f64 {
    MARGIN_M.max(MARGIN_SHARE * drive.longest_m)
}

fn of_pulls(block: &Block<'_>, pulls: &[(u64, &Reeling)]) -> Vec<Row> {
    let error = |reeling: &Reeling| (reeling.simulated_n / reeling.certified_n - 1.0).abs();
    let errors: Sample = pulls.iter().map(|(_, reeling)| error(reeling)).collect();
    let mut rows = vec![block.row("pull_error_p95", errors.quantile(0.95), "", errors.len())];
    rows.extend(worst(block, "pull_error", "", pulls, error));
    rows
}

/// The mean, and the largest value with its seed.
fn worst<T>(
    block: &Block<'_>,
    metric: &str,
    unit: &str,
    all: &[(u64, &T)],
    of: impl Fn(&T) -> f64,
) -> [Row; 2] {
    let values: Vec<(u64, f64)> = all.iter().map(|(seed, one)| (*seed, of(one))).collect();
    let mean = values.iter().map(|(_, value)| *value).collect::<Sample>().mean();
    let largest = values.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let seed = largest.map_or_else(String::new, |(seed, _)| format!("seed {seed}"));
    let value = largest.map(|(_, value)| *value);
    [
        block.row(metric, mean, unit, values.len()),
        block.row(&format!("{metric}_max"), value, unit, values.len()).note(seed),
    ]
}
