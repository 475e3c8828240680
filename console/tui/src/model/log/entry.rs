//! A line of the log.

use super::occurrence::What;
use account::clock;
use mission::Severity;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A line of the log.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// The tick of it.
    pub tick: u64,
    /// Mission time, seconds.
    pub t_s: f64,
    /// How much it asks of the operator.
    pub severity: Severity,
    /// Who speaks.
    pub source: Cow<'static, str>,
    /// What.
    pub text: String,
    /// How often in a row; the time is that of the last one.
    pub count: u32,
    /// The event behind it.
    pub what: What,
}

impl Entry {
    /// The line as it is copied out of the console.
    pub fn line(&self) -> String {
        format!("T+{} {} {} {}", clock(self.t_s), severity_word(self.severity), self.source, self.text)
    }

    /// Memory that it takes, bytes; near enough.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Self>() + self.text.len() + self.what.bytes()
    }
}

/// How a severity is written.
pub fn severity_word(severity: Severity) -> &'static str {
    match severity {
        Severity::Info => "INFO",
        Severity::Watch => "WATCH",
        Severity::Warn => "WARN",
        Severity::Crit => "CRIT",
    }
}
