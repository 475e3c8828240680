//! The result of a mission.

use account::Summary;
use mission::Outcome;
use serde_json::Value;

/// Whether a mission was flown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Flown to its end.
    Flown,
    /// The scenario or the planner refuses a value of the plan; flying the mission again would change nothing.
    Refused,
    /// The program failed repeatedly.
    Failed,
}

impl Status {
    /// The word used in the table.
    pub fn word(self) -> &'static str {
        match self {
            Self::Flown => "flown",
            Self::Refused => "refused",
            Self::Failed => "failed",
        }
    }
}

/// The result of a mission. Equal missions have equal results, regardless of who flew them and when.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Number of the mission.
    pub case: u64,
    /// Whether it was flown.
    pub status: Status,
    /// Why it was not flown, as a sentence.
    pub error: Option<String>,
    /// Whether it is complete and kept every bound.
    pub success: bool,
    /// Its report, as JSON; null if it was not flown.
    pub(crate) report: Value,
}

impl Row {
    /// The row of a mission that was flown to its end, without wall-clock figures and the account of the floor.
    pub fn flown(case: u64, summary: Summary) -> Self {
        let success = summary.outcome == Some(Outcome::Complete)
            && summary.violations.as_ref().is_none_or(Vec::is_empty);
        let report = Summary { floor: None, wall_time_s: None, planner_calls: None, ..summary };
        let report = serde_json::to_value(&report).unwrap_or_default();
        Self { case, status: Status::Flown, error: None, success, report }
    }

    /// The row of a mission that was not flown, with the reason.
    pub fn not_flown(case: u64, status: Status, error: String) -> Self {
        Self { case, status, error: Some(error), success: false, report: Value::Null }
    }

    /// Whether a planner failed while it was flown.
    pub fn has_faults(&self) -> bool {
        self.report["planner_faults"].as_u64().is_some_and(|faults| faults > 0)
    }

    /// The outcome in one word.
    pub fn word(&self) -> &str {
        self.report["outcome"].as_str().unwrap_or(self.status.word())
    }
}
