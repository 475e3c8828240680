//! How a method did over many truths.

use crate::{row::Row, sample::Sample};
use positioning::{Fix, FixError, Integrity};
use std::f64::consts::{PI, TAU};
use world::{Point, Station};

/// A fix further off than this without a warning is a danger, metres.
pub(super) const DANGER_M: f64 = 0.3;

/// What became of one cycle.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Outcome {
    /// Distance from the truth, metres; none without a fix.
    pub error_m: Option<f64>,
    /// Whether the truth lies in the 95 % ellipse.
    pub is_inside: bool,
    /// Whether the fix was trusted.
    pub is_trusted: bool,
    /// Time it took, microseconds.
    pub time_us: f64,
}

impl Outcome {
    /// How a fix compares with the truth.
    pub(super) fn of(fix: &Result<Fix, FixError>, truth: Point, time_us: f64) -> Self {
        let Ok(fix) = fix else { return Self { time_us, ..Self::default() } };
        let off = fix.position - truth;
        let squared = fix.covariance.try_inverse().map(|inverse| off.dot(&(inverse * off)));
        Self {
            error_m: Some(off.norm()),
            is_inside: squared.is_some_and(|s| s < -2.0 * 0.05_f64.ln()),
            is_trusted: fix.integrity == Integrity::Ok,
            time_us,
        }
    }
}

/// The rows of one method in one case.
pub(super) fn rows(table: &str, case: &str, method: &str, outcomes: &[Outcome]) -> Vec<Row> {
    let n = outcomes.len();
    let errors: Sample = outcomes.iter().filter_map(|o| o.error_m).collect();
    let share = |count: usize, of: usize| (of > 0).then(|| count as f64 / of as f64);
    let count = |is: fn(&Outcome) -> bool| outcomes.iter().filter(|o| is(o)).count();
    let missing = n - errors.len();
    let note = if missing > 0 { format!("{missing} of {n} cycles gave no fix") } else { String::new() };
    let row = |metric: &str, ours: Option<f64>, unit: &str| {
        Row::new(table, case, method, metric, ours, unit).of(n).note(note.clone())
    };
    let times: Sample = outcomes.iter().map(|o| o.time_us).collect();
    let wrong = count(|o| o.is_trusted && o.error_m.is_some_and(|e| e > DANGER_M));
    vec![
        row("mean_error", errors.mean(), "m"),
        row("p95_error", errors.quantile(0.95), "m"),
        row("in_95_ellipse", share(count(|o| o.is_inside), errors.len()), ""),
        row("unflagged_wrong_rate", share(wrong, n), ""),
        row("ok_rate", share(count(|o| o.is_trusted), n), ""),
        row("fix_time_us", times.mean(), "us").note("also counts when the machine did something else"),
        row("fix_time_us_median", times.median(), "us"),
    ]
}

/// Mean error of the best unbiased estimator for normal noise: the Cramér-Rao bound at a truth, metres.
///
/// A normal error of covariance `C` has the mean length `sqrt(pi / 2)` times the mean over all directions of
/// `sqrt(a cos^2 + b sin^2)`, with `a` and `b` the eigenvalues of `C`.
pub(super) fn cramer_rao_m(
    stations: &[Station],
    truth: Point,
    sigma_ratio: f64,
    repetitions: u32,
) -> Option<f64> {
    let mut information = nalgebra::Matrix2::zeros();
    for station in stations {
        let away = truth - station.position;
        let sigma_m = sigma_ratio * away.norm() / f64::from(repetitions).sqrt();
        let direction = away.try_normalize(1e-9)?;
        information += direction * direction.transpose() / sigma_m.powi(2);
    }
    let eigen = information.try_inverse()?.symmetric_eigenvalues();
    let length = |k: u32| {
        let angle = TAU * f64::from(k) / 64.0;
        (eigen[0] * angle.cos().powi(2) + eigen[1] * angle.sin().powi(2)).max(0.0).sqrt()
    };
    Some((PI / 2.0).sqrt() * (0..64).map(length).sum::<f64>() / 64.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::positioning::scene::Layout;

    #[test]
    fn the_bound_of_a_round_error_is_that_of_rayleigh() {
        // Four stations on a ring see the middle with the same error in all directions: sigma^2 / 2 each.
        let stations = Layout::Ring(4, 5.0).stations();
        let bound = cramer_rao_m(&stations, Point::origin(), 0.03, 9).expect("a good geometry");
        let sigma = 0.03 * 5.0 / 3.0 / 2.0_f64.sqrt();
        assert!((bound - sigma * (PI / 2.0).sqrt()).abs() < 1e-12, "{bound}");
    }

    #[test]
    fn a_trusted_fix_far_off_counts_as_danger() {
        let one = |error_m, is_trusted| Outcome { error_m, is_trusted, ..Outcome::default() };
        let outcomes = [one(Some(0.1), true), one(Some(0.5), true), one(Some(0.5), false), one(None, false)];
        let rows = rows("t", "c", "m", &outcomes);
        let value = |metric: &str| rows.iter().find(|r| r.metric == metric).and_then(|r| r.ours);
        assert_eq!(value("unflagged_wrong_rate"), Some(0.25));
        assert_eq!(value("ok_rate"), Some(0.5));
        assert!(rows[0].note.starts_with("1 of 4"));
    }
}
