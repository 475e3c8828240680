//! The result of a mission.

use account::Summary;
use mission::Outcome;
use serde_json::Value;

/// Whether a mission ran, and if not, why.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// The mission ran to its end.
    Flown,
    /// The scenario or the planner refuses a value in the plan; running the mission again would change nothing.
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

/// The result of a mission. Equal missions have equal results, whichever worker ran them.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Number of the mission.
    pub case: u64,
    /// Whether the mission ran.
    pub status: Status,
    /// The reason why the mission did not run, as a sentence.
    pub error: Option<String>,
    /// Whether the mission is complete and met every bound.
    pub success: bool,
    /// The report on the mission, as JSON; null if the mission did not run.
    pub(crate) report: Value,
}

impl Row {
    /// The row for a mission that ran to its end, without wall-clock figures and without the account of the floor.
    pub fn flown(case: u64, summary: Summary) -> Self {
        let success = summary.outcome == Some(Outcome::Complete)
            && summary.violations.as_ref().is_none_or(Vec::is_empty);
        let report = Summary { floor: None, wall_time_s: None, planner_calls: None, ..summary };
        let report = serde_json::to_value(&report).unwrap_or_default();
        Self { case, status: Status::Flown, error: None, success, report }
    }

    /// The row for a mission that did not run, with the reason.
    pub fn not_flown(case: u64, status: Status, error: String) -> Self {
        Self { case, status, error: Some(error), success: false, report: Value::Null }
    }

    /// Whether a planner failed during the mission.
    pub fn has_faults(&self) -> bool {
        self.report["planner_faults"].as_u64().is_some_and(|faults| faults > 0)
    }

    /// The outcome, in one word.
    pub fn word(&self) -> &str {
        self.report["outcome"].as_str().unwrap_or(self.status.word())
    }
}
