//! The evaluation of a trial of a vehicle: messages, stops and frames, each as a row with figures and a verdict. The
//! caller connects to the vehicle, drives it and collects its messages; `tankops check --vehicle` prints the rows.

mod frames;
mod link;
mod scans;
mod stops;

pub use frames::{Moved, ahead, turned};
pub use link::{Lines, Listened, clock, clock_rate, introduction, messages, readings, standstill, state};
pub use scans::scanner;
pub use stops::{Cause, Limits, QUIET_S, Sample, moved_again, moving_m_per_s, stands, stop};

use serde::Serialize;

/// Whether a vehicle passes a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The vehicle passes.
    Pass,
    /// The vehicle fails.
    Fail,
    /// The check gave no result.
    NotMeasured,
}

/// A measured value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figure {
    /// Its name.
    pub name: &'static str,
    /// The value.
    pub value: f64,
    /// Its unit; empty for a number or share.
    pub unit: &'static str,
    /// The greatest value with which the vehicle passes; absent if the value is not judged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_most: Option<f64>,
}

impl Figure {
    /// A value that is not judged.
    pub fn new(name: &'static str, value: f64, unit: &'static str) -> Self {
        Self { name, value, unit, at_most: None }
    }

    /// The same value with a limit.
    #[must_use]
    pub fn at_most(self, most: f64) -> Self {
        Self { at_most: Some(most), ..self }
    }

    fn exceeds(&self) -> bool {
        self.at_most.is_some_and(|most| self.value > most || self.value.is_nan())
    }
}

/// The result of a check.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// Name of the check.
    pub check: &'static str,
    /// The verdict.
    pub verdict: Verdict,
    /// The measured values.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub figures: Vec<Figure>,
    /// The finding and, for a failure, the remedy, as a sentence without a full stop.
    pub says: String,
}

impl Row {
    /// A passed check.
    pub fn pass(check: &'static str, figures: Vec<Figure>, says: impl Into<String>) -> Self {
        Self { check, verdict: Verdict::Pass, figures, says: says.into() }
    }

    /// A failed check.
    pub fn fail(check: &'static str, figures: Vec<Figure>, says: impl Into<String>) -> Self {
        Self { check, verdict: Verdict::Fail, figures, says: says.into() }
    }

    /// A check without a result, with the reason.
    pub fn not_measured(check: &'static str, why: impl Into<String>) -> Self {
        Self { check, verdict: Verdict::NotMeasured, figures: Vec::new(), says: why.into() }
    }

    /// A check that passes if no figure exceeds its limit.
    fn judged(check: &'static str, figures: Vec<Figure>, passed: &str, failed: &str) -> Self {
        if figures.iter().any(Figure::exceeds) {
            Self::fail(check, figures, failed)
        } else {
            Self::pass(check, figures, passed)
        }
    }
}
