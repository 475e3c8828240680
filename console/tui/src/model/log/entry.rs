//! A line of the log.

use super::occurrence::What;
use account::clock;
use mission::{EventKind, Severity};
use planner_api::LogLevel;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A line of the log.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// The tick.
    pub tick: u64,
    /// Mission time, seconds.
    pub t_s: f64,
    /// The severity.
    pub severity: Severity,
    /// The source of the line.
    pub source: Cow<'static, str>,
    /// The text.
    pub text: String,
    /// How many times in a row the line occurred; the line has the time of the last occurrence.
    pub count: u32,
    /// The event that the line reports.
    pub what: What,
}

impl Entry {
    /// Whether the line is a planner's message about its own work, which is hidden unless the filter asks for it.
    pub fn is_chatter(&self) -> bool {
        let kind = self.what.event().map(|event| &event.kind);
        matches!(kind, Some(EventKind::PlannerLogged { level: LogLevel::Debug | LogLevel::Info, .. }))
    }

    /// The line as copied to the clipboard.
    pub fn line(&self) -> String {
        format!("T+{} {} {} {}", clock(self.t_s), severity_word(self.severity), self.source, self.text)
    }

    /// The approximate memory use, bytes.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Self>() + self.text.len() + self.what.bytes()
    }
}

/// The word for a severity.
pub fn severity_word(severity: Severity) -> &'static str {
    match severity {
        Severity::Info => "INFO",
        Severity::Watch => "WATCH",
        Severity::Warn => "WARN",
        Severity::Crit => "CRIT",
    }
}
