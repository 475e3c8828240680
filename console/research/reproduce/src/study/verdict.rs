//! How a figure of ours compares with the printed one.

use super::row::Row;
use serde::{Deserialize, Serialize};

/// Difference, as a share of the printed figure, up to which a figure is reproduced.
const NEAR: f64 = 0.05;
/// Difference below which two values are equal.
const EQUAL: f64 = 1e-9;

/// How a figure of ours compares with the printed one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Within 5 % of the printed figure or, if the paper prints a single draw, within the 95 % interval of one draw.
    Reproduced,
    /// Equally close, but with a number or a layout that was fitted to the printed values.
    Fitted,
    /// Further from the printed figure, but better.
    Better,
    /// Further from the printed figure, and worse.
    NotReproduced,
}

impl Verdict {
    /// The verdict in human-readable words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Fitted => "fitted",
            Self::Better => "better",
            Self::NotReproduced => "not reproduced",
        }
    }
}

/// The good values of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Good {
    Low,
    High,
    /// Only the printed value.
    Equal,
}

/// Determines the good values from the name of the figure; a median is treated like its mean.
fn good(metric: &str) -> Good {
    match metric.trim_end_matches("_median") {
        "ok_rate"
        | "success_rate"
        | "precision"
        | "recall"
        | "cross_track_precision"
        | "coverage"
        | "rmse_reduction" => Good::High,
        "rmse" | "cross_track_rmse" | "plan_time_ms" | "collisions" | "wall_exits" | "mean_error"
        | "max_error" => Good::Low,
        _ => Good::Equal,
    }
}

/// Sets the difference, the interval of a rate, and the verdict.
pub(crate) fn judged(mut row: Row, is_seeded: bool) -> Row {
    row.seeded = is_seeded;
    let is_rate = row.unit.is_empty() && row.metric.ends_with("_rate") && row.n > 1;
    if let Some(rate) = row.ours.filter(|_| is_rate && is_seeded && row.interval_95.is_none()) {
        row.interval_95 = Some(wilson(rate, row.n));
    }
    let Some(paper) = row.paper else { return row };
    row.difference = row.ours.map(|ours| ours - paper);
    let (verdict, why) = verdict(&row, paper);
    (row.verdict, row.why) = (Some(verdict), why);
    row
}

fn verdict(row: &Row, paper: f64) -> (Verdict, String) {
    let Some(ours) = row.ours else {
        return (Verdict::NotReproduced, "nothing could be measured".into());
    };
    let off = ours - paper;
    let is_within = row.interval_95.is_some_and(|[low, high]| (low..=high).contains(&paper));
    // A printed 0 is rounded to a few digits; any other printed value is compared by its own size, however small.
    let is_near = off.abs() <= if paper == 0.0 { EQUAL } else { NEAR * paper.abs() };
    if is_near || (is_within && row.is_of_one_draw) {
        return (if row.is_fitted { Verdict::Fitted } else { Verdict::Reproduced }, String::new());
    }
    if row.is_claim && ours * paper < 0.0 {
        return (Verdict::NotReproduced, format!("the sign of the claim is not reproduced: {}", claim(row)));
    }
    let is_good = match good(&row.metric) {
        Good::Low => off < 0.0,
        Good::High => off > 0.0,
        Good::Equal => false,
    };
    let far = far(off, paper);
    match (is_within, is_good) {
        (true, _) => {
            let why =
                format!("{far}, but the interval contains the printed value: use more layouts to decide");
            (Verdict::NotReproduced, why)
        }
        (false, true) => (Verdict::Better, far),
        (false, false) => (Verdict::NotReproduced, far),
    }
}

/// Describes the difference between our value and the printed one.
fn far(off: f64, paper: f64) -> String {
    let side = if off > 0.0 { "above" } else { "below" };
    match paper.abs() {
        0.0 => format!("ours is {:.4} {side} the printed 0", off.abs()),
        size => match off.abs() / size {
            share if share < 10.0 => format!("ours is {:.1} % {side} the printed value", 100.0 * share),
            share => format!("ours is {side} the printed value by {share:.0} times its size"),
        },
    }
}

/// Formats the printed value of a claim and ours in per cent, with the interval.
fn claim(row: &Row) -> String {
    let signed = |value: f64| format!("{:+.1} %", 100.0 * value);
    let [paper, ours] = [row.paper, row.ours].map(|value| value.map(signed).unwrap_or_default());
    let interval = row
        .interval_95
        .map(|[low, high]| format!(" (95 % interval {} to {})", signed(low), signed(high)))
        .unwrap_or_default();
    format!("printed {paper}, ours {ours}{interval}")
}

/// 95 % interval of a rate (Wilson's score).
fn wilson(rate: f64, n: usize) -> [f64; 2] {
    const Z: f64 = 1.96;
    let n = n as f64;
    let middle = rate + Z * Z / (2.0 * n);
    let half = Z * (rate * (1.0 - rate) / n + Z * Z / (4.0 * n * n)).sqrt();
    [(middle - half).max(0.0), (middle + half).min(1.0 + Z * Z / n)]
        .map(|v| (v / (1.0 + Z * Z / n)).clamp(0.0, 1.0))
}

/// The claims whose sign is not reproduced, one sentence each; computed from the rows.
pub(crate) fn wrong_signs(rows: &[Row]) -> Vec<String> {
    let is_wrong = |row: &&Row| row.is_claim && row.paper.zip(row.ours).is_some_and(|(p, o)| p * o < 0.0);
    let told = |row: &Row| {
        let Row { table, case, method, metric, .. } = row;
        format!("{table}, {case}: {metric} of {method}: {}", claim(row))
    };
    rows.iter().filter(is_wrong).map(told).collect()
}

/// The blocks of rows that do not depend on a seed, with the number of rows of each: `--first-seed` does not change
/// them.
pub(crate) fn without_seed(rows: &[Row]) -> Vec<(String, usize)> {
    let mut counts: Vec<(String, usize)> = Vec::new();
    for row in rows.iter().filter(|row| !row.seeded) {
        let name = format!("{}, {}, {}", row.table, row.case, row.method);
        match counts.last_mut() {
            Some((last, n)) if *last == name => *n += 1,
            _ => counts.push((name, 1)),
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::{Block, Sample};

    fn row(metric: &str, ours: impl Into<Option<f64>>, paper: f64) -> Row {
        let block = Block { table: "t", case: "c", method: "m", note: "" };
        block.row(metric, ours, "m", 60).printed(paper)
    }

    fn told(row: Row) -> (Option<Verdict>, String) {
        let row = judged(row, true);
        (row.verdict, row.why)
    }

    #[test]
    fn near_is_reproduced_and_farther_is_better_or_not() {
        assert_eq!(told(row("rmse", 0.104, 0.1)), (Some(Verdict::Reproduced), String::new()));
        assert_eq!(
            told(row("rmse", 0.08, 0.1)),
            (Some(Verdict::Better), "ours is 20.0 % below the printed value".into())
        );
        assert_eq!(told(row("recall", 0.5, 0.4)).0, Some(Verdict::Better));
        assert_eq!(
            told(row("recall", 0.2, 0.4)),
            (Some(Verdict::NotReproduced), "ours is 50.0 % below the printed value".into())
        );
        assert_eq!(
            told(row("stop_x", 40.0, 44.0)).0,
            Some(Verdict::NotReproduced),
            "no side of a place is good"
        );
        assert_eq!(told(row("success_rate", 0.0, 0.0)).0, Some(Verdict::Reproduced));
        assert_eq!(told(row("rmse", None, 0.1)).1, "nothing could be measured");
        assert_eq!(judged(Row { paper: None, ..row("rmse", 1.0, 1.0) }, true).verdict, None);
    }

    #[test]
    fn an_interval_that_holds_the_printed_value_decides_nothing() {
        let sample: Sample = [0.05, 0.15, 0.25].into_iter().collect();
        let block = Block { table: "t", case: "c", method: "m", note: "" };
        let [mean, _] = block.mean_and_median("rmse", &sample, "m");
        let row = judged(mean.printed(0.2), true);
        let [low, high] = row.interval_95.unwrap();
        assert!(low < 0.15 && high > 0.2, "{row:?}");
        assert!(row.why.ends_with("use more layouts to decide"), "{row:?}");
    }

    #[test]
    fn what_is_printed_of_one_draw_is_reproduced_where_single_draws_lie() {
        let values: Sample = (0..100).map(|k| 0.1 + 0.001 * f64::from(k)).collect();
        let row = |paper| judged(row("best", values.mean(), paper).of_one_draw(values.range_95()), true);
        assert_eq!(row(0.11).verdict, Some(Verdict::Reproduced));
        assert_eq!(row(0.09).verdict, Some(Verdict::NotReproduced));
    }

    #[test]
    fn a_claim_of_the_other_sign_is_said() {
        let mut claimed = row("rmse_reduction", -0.3, 0.0949).claimed(Some([-0.35, -0.25]));
        claimed = judged(claimed, true);
        let sentence = "printed +9.5 %, ours -30.0 % (95 % interval -35.0 % to -25.0 %)";
        assert_eq!(claimed.why, format!("the sign of the claim is not reproduced: {sentence}"));
        assert_eq!(wrong_signs(&[claimed]), [format!("t, c: rmse_reduction of m: {sentence}")]);
        assert!(wrong_signs(&[judged(row("rmse_reduction", 0.05, 0.0949).claimed(None), true)]).is_empty());
    }

    #[test]
    fn a_rate_has_an_interval_unless_nothing_is_drawn() {
        let block = Block { table: "t", case: "c", method: "m", note: "" };
        let rate = |n| block.row("ok_rate", 1.0, "", n);
        let [low, high] = judged(rate(60), true).interval_95.unwrap();
        assert!((low - 0.94).abs() < 0.002 && (high - 1.0).abs() < 1e-9, "{low} {high}");
        assert_eq!(judged(rate(1), false).interval_95, None);
        assert_eq!(without_seed(&[judged(rate(1), false), judged(rate(60), true)]), [("t, c, m".into(), 1)]);
    }
}
