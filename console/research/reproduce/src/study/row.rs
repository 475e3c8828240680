//! One figure of a table.

use super::{sample::Sample, verdict::Verdict};
use serde::{Deserialize, Serialize};

/// One of our figures beside the printed one.
///
/// Rates are fractions from 0 to 1; means have the plain metric id, medians end in `_median`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(clippy::struct_excessive_bools, reason = "each is a separate column")]
pub struct Row {
    /// Name of the study.
    pub table: String,
    /// Id of the case: `d1/disk`, `table1`, `case3`.
    pub case: String,
    /// Planner or estimator id, its mode after a slash: `rpf/literal`.
    pub method: String,
    /// Id of the metric: `ok_rate`, `rmse`.
    pub metric: String,
    /// The printed value; `None` where nothing is printed.
    pub paper: Option<f64>,
    /// Our value; `None` where nothing could be measured, with the reason in the note.
    pub ours: Option<f64>,
    /// Unit; empty for pure numbers.
    pub unit: String,
    /// Number of layouts or draws behind the figure.
    pub n: usize,
    /// A note for the reader; empty if there is none.
    pub note: String,
    /// Our value minus the printed value.
    #[serde(default)]
    pub difference: Option<f64>,
    /// 95 % interval of our value over layouts or draws; `None` for a single draw, or where the interval is unknown.
    #[serde(default)]
    pub interval_95: Option<[f64; 2]>,
    /// Whether the interval is that of a single draw, because the printed value is a single draw.
    #[serde(default)]
    pub is_of_one_draw: bool,
    /// The verdict on the printed value; `None` where nothing is printed.
    #[serde(default)]
    pub verdict: Option<Verdict>,
    /// The reason for the verdict; empty if reproduced.
    #[serde(default)]
    pub why: String,
    /// Whether the row depends on `--first-seed`.
    #[serde(default = "is_seeded")]
    pub seeded: bool,
    /// Whether the row is a claim of the paper, whose sign matters.
    #[serde(default)]
    pub is_claim: bool,
    /// Whether a number or a layout behind our value was fitted to the printed values.
    #[serde(default)]
    pub is_fitted: bool,
}

fn is_seeded() -> bool {
    true
}

impl Row {
    /// Adds the 95 % interval.
    pub(crate) fn within(self, interval_95: Option<[f64; 2]>) -> Self {
        Self { interval_95, ..self }
    }

    /// Adds the 95 % interval of a single draw, because the printed value is a single draw.
    pub(crate) fn of_one_draw(self, interval_95: Option<[f64; 2]>) -> Self {
        Self { is_of_one_draw: true, interval_95, ..self }
    }

    /// Marks the row as a claim of the paper, with its 95 % interval.
    pub(crate) fn claimed(self, interval_95: Option<[f64; 2]>) -> Self {
        Self { is_claim: true, interval_95, ..self }
    }

    /// Adds the printed value.
    pub(crate) fn printed(self, paper: impl Into<Option<f64>>) -> Self {
        Self { paper: paper.into(), ..self }
    }

    /// Marks a row whose number or layout was fitted to the printed values: its agreement confirms nothing.
    pub(crate) fn fitted(self) -> Self {
        Self { is_fitted: true, ..self }
    }

    /// Sets a note for the reader, instead of the note of the block.
    pub(crate) fn note(self, note: impl Into<String>) -> Self {
        Self { note: note.into(), ..self }
    }
}

/// The rows of one method in one case.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Block<'a> {
    /// Name of the study.
    pub table: &'a str,
    /// Id of the case.
    pub case: &'a str,
    /// Id of the method.
    pub method: &'a str,
    /// The note on every row; empty if there is none.
    pub note: &'a str,
}

impl Block<'_> {
    /// A row over this number of layouts or draws, without a printed value.
    ///
    /// A value that is not finite is treated as missing, because JSON cannot represent it.
    pub(crate) fn row(&self, metric: &str, ours: impl Into<Option<f64>>, unit: &str, n: usize) -> Row {
        Row {
            table: self.table.into(),
            case: self.case.into(),
            method: self.method.into(),
            metric: metric.into(),
            paper: None,
            ours: ours.into().filter(|value| value.is_finite()),
            unit: unit.into(),
            n,
            note: self.note.into(),
            difference: None,
            interval_95: None,
            is_of_one_draw: false,
            verdict: None,
            why: String::new(),
            seeded: true,
            is_claim: false,
            is_fitted: false,
        }
    }

    /// The mean, and the median with its own id.
    pub(crate) fn mean_and_median(&self, metric: &str, sample: &Sample, unit: &str) -> [Row; 2] {
        let n = sample.len();
        [
            self.row(metric, sample.mean(), unit, n).within(sample.mean_interval_95()),
            self.row(&format!("{metric}_median"), sample.median(), unit, n)
                .within(sample.median_interval_95()),
        ]
    }
}
