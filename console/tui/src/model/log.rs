//! What happened, newest last, in a bounded number of lines.

use mission::Severity;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Most lines kept.
const MAX_LINES: usize = 10_000;

/// A line of the log.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Mission time, seconds.
    pub t_s: f64,
    /// How much it asks of the operator.
    pub severity: Severity,
    /// Who speaks.
    pub source: String,
    /// What.
    pub text: String,
    /// How often in a row; the time is that of the last one.
    pub count: u32,
}

/// What happened, newest last.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Log {
    entries: VecDeque<Entry>,
}

impl Log {
    /// Adds a line; the same line again raises the count of the last one.
    pub fn add(&mut self, t_s: f64, severity: Severity, source: &str, text: String) {
        if let Some(last) = self.entries.back_mut()
            && last.severity == severity
            && last.source == source
            && last.text == text
        {
            last.count = last.count.saturating_add(1);
            last.t_s = t_s;
            return;
        }
        if self.entries.len() >= MAX_LINES {
            self.entries.pop_front();
        }
        self.entries.push_back(Entry { t_s, severity, source: source.to_owned(), text, count: 1 });
    }

    /// Lines that pass the filter, newest first. What is critical always passes.
    pub fn shown<'a>(&'a self, least: Severity, needle: &'a str) -> impl Iterator<Item = &'a Entry> {
        let needle = needle.to_lowercase();
        self.entries.iter().rev().filter(move |entry| {
            let found = needle.is_empty()
                || entry.source.contains(&needle)
                || entry.text.to_lowercase().contains(&needle);
            entry.severity == Severity::Crit || (entry.severity >= least && found)
        })
    }

    /// How many lines there are.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether nothing happened yet.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_line_again_is_counted_and_not_repeated() {
        let mut log = Log::default();
        for t_s in [1.0, 2.0, 3.0] {
            log.add(t_s, Severity::Watch, "ae", "station 2 rejected".into());
        }
        let lines: Vec<&Entry> = log.shown(Severity::Info, "").collect();
        assert_eq!((lines.len(), lines[0].count, lines[0].t_s), (1, 3, 3.0));
    }

    #[test]
    fn what_is_critical_cannot_be_filtered_away() {
        let mut log = Log::default();
        log.add(1.0, Severity::Crit, "ae", "position lost".into());
        log.add(2.0, Severity::Info, "plan", "planned".into());
        let texts: Vec<&str> = log.shown(Severity::Warn, "column").map(|e| e.text.as_str()).collect();
        assert_eq!(texts, ["position lost"]);
    }

    #[test]
    fn old_lines_make_room() {
        let mut log = Log::default();
        for i in 0..MAX_LINES + 5 {
            log.add(i as f64, Severity::Info, "mission", i.to_string());
        }
        assert_eq!(log.len(), MAX_LINES);
    }
}
