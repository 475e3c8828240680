//! What came of a mission.

use account::Summary;
use mission::Outcome;
use serde_json::Value;

/// Whether a mission was flown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// To its end.
    Flown,
    /// Its scenario or its planner does not take what the plan sets; flying it again changes nothing.
    Refused,
    /// The program failed, again and again.
    Failed,
}

impl Status {
    /// As the table has it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Flown => "flown",
            Self::Refused => "refused",
            Self::Failed => "failed",
        }
    }
}

/// What came of a mission: equal for equal missions, whoever flew them and when.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Number of the mission.
    pub case: u64,
    /// Whether it was flown.
    pub status: Status,
    /// Why not, as a sentence.
    pub error: Option<String>,
    /// Whether it is complete and kept every bound.
    pub success: bool,
    /// Its report, as JSON; null if it was not flown.
    pub(crate) report: Value,
}

impl Row {
    /// A mission that came to its end; figures by the wall clock and the account of the floor are left out.
    pub fn flown(case: u64, summary: Summary) -> Self {
        let success = summary.outcome == Some(Outcome::Complete)
            && summary.violations.as_ref().is_none_or(Vec::is_empty);
        let report = Summary { floor: None, wall_time_s: None, planner_calls: None, ..summary };
        let report = serde_json::to_value(&report).unwrap_or_default();
        Self { case, status: Status::Flown, error: None, success, report }
    }

    /// A mission that was not flown, and why.
    pub fn not_flown(case: u64, status: Status, error: String) -> Self {
        Self { case, status, error: Some(error), success: false, report: Value::Null }
    }

    /// Whether a planner failed while it was flown.
    pub fn has_faults(&self) -> bool {
        self.report["planner_faults"].as_u64().is_some_and(|faults| faults > 0)
    }

    /// How it ended, in a word.
    pub fn word(&self) -> &str {
        self.report["outcome"].as_str().unwrap_or(self.status.word())
    }
}
