//! One figure of a table.

use super::sample::Sample;
use serde::{Deserialize, Serialize};

/// A figure of ours beside the printed one.
///
/// Rates are fractions from 0 to 1; means carry the plain metric id, medians end in `_median`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name of the study.
    pub table: String,
    /// What was solved: `d1/disk`, `table1`, `case3`.
    pub case: String,
    /// Planner or estimator id, its mode after a slash: `rpf/literal`.
    pub method: String,
    /// What was measured: `ok_rate`, `rmse`.
    pub metric: String,
    /// The printed value; none where nothing is printed.
    pub paper: Option<f64>,
    /// Our value; none where nothing could be measured, and the note says why.
    pub ours: Option<f64>,
    /// Unit; empty for pure numbers.
    pub unit: String,
    /// Number of layouts or draws behind the figure.
    pub n: usize,
    /// What a reader must know; empty if nothing.
    pub note: String,
}

impl Row {
    /// With the printed value.
    pub(crate) fn printed(self, paper: impl Into<Option<f64>>) -> Self {
        Self { paper: paper.into(), ..self }
    }

    /// With something that a reader must know, instead of the note of the block.
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
    /// What a reader must know of every row; empty if nothing.
    pub note: &'a str,
}

impl Block<'_> {
    /// A row of so many layouts or draws, without a printed value.
    ///
    /// A value that is not finite counts as none: JSON has no such numbers.
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
        }
    }

    /// The mean, and the median under an id of its own.
    pub(crate) fn mean_and_median(&self, metric: &str, sample: &Sample, unit: &str) -> [Row; 2] {
        let n = sample.len();
        [
            self.row(metric, sample.mean(), unit, n),
            self.row(&format!("{metric}_median"), sample.median(), unit, n),
        ]
    }
}
