//! One figure of a table.

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
    /// A figure without a printed value and without a note.
    ///
    /// A value that is not finite counts as none: JSON has no such numbers.
    pub fn new(table: &str, case: &str, method: &str, metric: &str, ours: Option<f64>, unit: &str) -> Self {
        Self {
            table: table.into(),
            case: case.into(),
            method: method.into(),
            metric: metric.into(),
            paper: None,
            ours: ours.filter(|value| value.is_finite()),
            unit: unit.into(),
            n: 1,
            note: String::new(),
        }
    }

    /// With the number of layouts or draws behind it.
    #[must_use]
    pub fn of(self, n: usize) -> Self {
        Self { n, ..self }
    }

    /// With the printed value.
    #[must_use]
    pub fn printed(self, paper: impl Into<Option<f64>>) -> Self {
        Self { paper: paper.into(), ..self }
    }

    /// With something that a reader must know.
    #[must_use]
    pub fn note(self, note: impl Into<String>) -> Self {
        Self { note: note.into(), ..self }
    }
}
