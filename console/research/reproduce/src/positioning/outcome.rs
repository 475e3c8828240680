//! The results of a method over many true positions.

use crate::study::{Block, Result, Row, Sample};
use nalgebra::Matrix2;
use positioning::{Fix, FixError, Integrity};
use serde::{Deserialize, Serialize};
use world::Point;

/// Error, metres, above which a fix without a warning is dangerous.
const DANGER_M: f64 = 0.3;

/// The outcome of one cycle.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Outcome {
    /// Distance from the true position, metres; `None` without a fix.
    pub error_m: Option<f64>,
    /// Whether the true position is inside the 95 % ellipse.
    pub is_inside: bool,
    /// Whether the fix was trusted.
    pub is_trusted: bool,
    /// Computing time, microseconds.
    pub time_us: f64,
}

impl Outcome {
    /// Compares a fix with the true position.
    pub(super) fn of(fix: &Result<Fix, FixError>, truth: Point, time_us: f64) -> Self {
        let Ok(fix) = fix else { return Self { time_us, ..Self::default() } };
        let is_trusted = fix.integrity == Integrity::Ok;
        Self { is_trusted, time_us, ..Self::of_estimate(fix.position, &fix.covariance, truth) }
    }

    /// Compares an estimate and its covariance (square metres) with the true position.
    pub(super) fn of_estimate(position: Point, covariance: &Matrix2<f64>, truth: Point) -> Self {
        let off = position - truth;
        let squared = covariance.try_inverse().map(|inverse| off.dot(&(inverse * off)));
        // Quantile of the chi-squared distribution with two degrees of freedom: -2 ln 0.05.
        let is_inside = squared.is_some_and(|s| s < -2.0 * 0.05_f64.ln());
        Self { error_m: Some(off.norm()), is_inside, ..Self::default() }
    }
}

/// The errors of the cycles that gave a fix, metres.
pub(super) fn errors<'a>(outcomes: impl IntoIterator<Item = &'a Outcome>) -> Sample {
    outcomes.into_iter().filter_map(|outcome| outcome.error_m).collect()
}

/// The rows of one method in one case.
pub(super) fn rows(block: &Block<'_>, outcomes: &[Outcome]) -> Vec<Row> {
    let n = outcomes.len();
    let errors = errors(outcomes);
    let share = |count: usize, of: usize| (of > 0).then(|| count as f64 / of as f64);
    let count = |is: fn(&Outcome) -> bool| outcomes.iter().filter(|o| is(o)).count();
    let missing = n - errors.len();
    let note = if missing > 0 { format!("{missing} of {n} cycles gave no fix") } else { String::new() };
    let block = Block { note: &note, ..*block };
    let times: Sample = outcomes.iter().map(|o| o.time_us).collect();
    let wrong = count(|o| o.is_trusted && o.error_m.is_some_and(|e| e > DANGER_M));
    vec![
        block.row("mean_error", errors.mean(), "m", n),
        block.row("p95_error", errors.quantile(0.95), "m", n),
        block.row("in_95_ellipse", share(count(|o| o.is_inside), errors.len()), "", n),
        block.row("unflagged_wrong_rate", share(wrong, n), "", n),
        block.row("ok_rate", share(count(|o| o.is_trusted), n), "", n),
        block.row("fix_time_us", times.mean(), "us", n).note("includes interruptions by other processes"),
        block.row("fix_time_us_median", times.median(), "us", n),
    ]
}

/// The rows of one method over whole runs: mean and deviation of the runs, and figures over all of their steps.
pub(super) fn run_rows(block: &Block<'_>, runs: &[&Vec<Outcome>]) -> Vec<Row> {
    let n = runs.len();
    let means: Sample = runs.iter().filter_map(|run| errors(*run).mean()).collect();
    let all = || runs.iter().flat_map(|run| run.iter());
    let inside = all().filter(|o| o.is_inside).count() as f64 / all().count() as f64;
    let errors = errors(all());
    vec![
        block.row("mean_error", means.mean(), "m", n),
        block.row("std", means.standard_deviation(), "m", n),
        block.row("p95_error", errors.quantile(0.95), "m", n),
        block.row("worst", errors.max(), "m", n),
        block.row("in_95_ellipse", inside, "", n),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trusted_fix_far_off_counts_as_danger() {
        let one = |error_m, is_trusted| Outcome { error_m, is_trusted, ..Outcome::default() };
        let outcomes = [one(Some(0.1), true), one(Some(0.5), true), one(Some(0.5), false), one(None, false)];
        let rows = rows(&Block { table: "t", case: "c", method: "m", note: "" }, &outcomes);
        let value = |metric: &str| rows.iter().find(|r| r.metric == metric).and_then(|r| r.ours);
        assert_eq!(value("unflagged_wrong_rate"), Some(0.25));
        assert_eq!(value("ok_rate"), Some(0.5));
        assert!(rows[0].note.starts_with("1 of 4"));
    }
}
