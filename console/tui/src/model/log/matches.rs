//! The lines that pass a filter, kept up to date as lines arrive and the filter changes.

use super::entry::Entry;
use super::filter::Filter;
use super::lines::Log;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The lines that pass a filter.
///
/// Each new line is tested once. All lines are tested again only when the filter changes, which takes 2 to 6 ms for
/// 100,000 lines (bench `events`).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Matches {
    text: String,
    filter: Filter,
    /// The numbers of the lines that pass, ascending.
    found: VecDeque<u64>,
    /// All lines before this number have already been tested.
    seen: u64,
}

impl Matches {
    /// Updates the matches to a filter and a log.
    pub fn refresh(&mut self, text: &str, log: &Log) {
        if self.text != text {
            (self.text, self.filter) = (text.to_owned(), Filter::parse(text));
            self.seen = 0;
        }
        // A new run begins with fewer lines.
        if self.seen > log.end() {
            self.seen = 0;
        }
        // The newest line may have been repeated since then.
        let from = self.seen.saturating_sub(1).max(log.oldest());
        while self.found.back().is_some_and(|number| *number >= from) {
            self.found.pop_back();
        }
        while self.found.front().is_some_and(|number| *number < log.oldest()) {
            self.found.pop_front();
        }
        self.found.extend(log.passing(&self.filter, from));
        self.seen = log.end();
    }

    /// The parsed filter.
    pub fn filter(&self) -> &Filter {
        &self.filter
    }

    /// The number of lines that pass.
    pub fn len(&self) -> usize {
        self.found.len()
    }

    /// Whether no line passes.
    pub fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// The number of passing lines that are newer than the given one.
    pub fn newer_than(&self, number: u64) -> usize {
        self.found.len() - self.found.partition_point(|found| *found <= number)
    }

    /// The number of the passing line that is followed by `newer` newer ones; the oldest line if there are fewer.
    pub fn number(&self, newer: usize) -> Option<u64> {
        let index = self.found.len().checked_sub(1)?.saturating_sub(newer);
        self.found.get(index).copied()
    }

    /// Numbers and lines, newest first, skipping the first `skip`.
    pub fn newest<'a>(&'a self, log: &'a Log, skip: usize) -> impl Iterator<Item = (u64, &'a Entry)> {
        self.found.iter().rev().skip(skip).filter_map(|number| Some((*number, log.get(*number)?)))
    }

    /// The next line of the same kind within the next `among` lines, or within the preceding ones if `back` is set.
    pub fn next_like(&self, log: &Log, number: u64, back: bool, among: usize) -> Option<u64> {
        let what = &log.get(number)?.what;
        let at = self.found.partition_point(|found| *found < number);
        let is_like = |other: &u64| log.get(*other).is_some_and(|other| other.what.is_like(what));
        if back {
            self.found.range(..at).rev().copied().take(among).find(is_like)
        } else {
            let after = self.found.range(at..).copied().skip_while(|found| *found == number);
            after.take(among).find(is_like)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{MAX_LINES, What};
    use super::*;
    use mission::Severity;

    fn texts<'a>(matches: &'a Matches, log: &'a Log) -> Vec<&'a str> {
        matches.newest(log, 0).map(|(_, entry)| entry.text.as_str()).collect()
    }

    /// What refreshing step by step has to agree with.
    fn fresh(text: &str, log: &Log) -> Matches {
        let mut matches = Matches::default();
        matches.refresh(text, log);
        matches
    }

    #[test]
    fn what_is_critical_cannot_be_filtered_away() {
        let mut log = Log::default();
        log.add(1.0, Severity::Crit, "ae", "position lost".into());
        log.add(2.0, Severity::Info, "plan", "planned".into());
        assert_eq!(texts(&fresh("sev>=warn column", &log), &log), ["position lost"]);
    }

    #[test]
    fn step_by_step_is_the_same_as_fresh() {
        let (mut log, mut matches) = (Log::default(), Matches::default());
        for (step, text) in ["", "a", "ab", "a", "-a", "t>5"].into_iter().cycle().take(60).enumerate() {
            for i in 0..step % 4 {
                log.add(step as f64, Severity::Info, "plan", format!("{}{}", ["a", "ab", "c"][i], step / 7));
            }
            matches.refresh(text, &log);
            assert_eq!(matches, fresh(text, &log), "{text} in step {step}");
        }
        matches.refresh("t>5", &Log::default());
        assert!(matches.is_empty(), "another run has begun");
    }

    #[test]
    fn a_line_that_is_counted_again_is_looked_at_again_and_dropped_lines_are_forgotten() {
        let (mut log, mut matches) = (Log::default(), Matches::default());
        for t_s in [1.0, 9.0] {
            log.add(t_s, Severity::Watch, "ae", "no fix".into());
            matches.refresh("t>5", &log);
        }
        assert_eq!(matches.len(), 1);
        for i in 0..MAX_LINES + 5000 {
            log.add(9.0, Severity::Info, "plan", i.to_string());
        }
        matches.refresh("t>5", &log);
        assert_eq!((matches.len(), matches.number(usize::MAX)), (log.len(), Some(log.oldest())));
    }

    #[test]
    fn places_are_found_by_number_even_of_lines_that_do_not_pass() {
        let mut log = Log::default();
        for i in 0..10 {
            let text = if i % 2 == 0 { "even" } else { "odd" };
            log.add(f64::from(i), Severity::Info, "plan", text.into());
        }
        let even = fresh("even", &log);
        assert_eq!([even.newer_than(8), even.newer_than(7), even.newer_than(0)], [0, 1, 4]);
        assert_eq!([even.number(0), even.number(1), even.number(99)], [Some(8), Some(6), Some(0)]);
        assert!(matches!(log.get(0).map(|entry| &entry.what), Some(What::Console)));
        assert_eq!([false, true].map(|back| even.next_like(&log, 4, back, 9)), [Some(6), Some(2)]);
        assert_eq!([false, true].map(|back| even.next_like(&log, 5, back, 9)), [Some(6), Some(4)]);
        assert_eq!([even.next_like(&log, 8, false, 9), even.next_like(&log, 0, true, 9)], [None, None]);
    }
}
