//! The review screen: past runs, filtered and sorted.

use super::{Home, PastRun};
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;

/// The sort order of the list of past runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum SortBy {
    /// By start, newest first.
    #[default]
    Date,
    /// By scenario.
    Scenario,
    /// By planner.
    Planner,
    /// By outcome.
    End,
    /// By scanned share of the reachable floor, largest first.
    Coverage,
    /// By mission time, longest first.
    Time,
}

impl SortBy {
    const ALL: [Self; 6] = [Self::Date, Self::Scenario, Self::Planner, Self::End, Self::Coverage, Self::Time];

    /// The name of the sort order.
    pub fn word(self) -> &'static str {
        match self {
            Self::Date => "date",
            Self::Scenario => "scenario",
            Self::Planner => "planner",
            Self::End => "end",
            Self::Coverage => "coverage",
            Self::Time => "time",
        }
    }

    /// The next sort order.
    #[must_use]
    pub fn next(self) -> Self {
        Self::ALL[(self as usize + 1) % Self::ALL.len()]
    }

    fn compare(self, one: &PastRun, other: &PastRun) -> Ordering {
        let number = |value: Option<f64>| value.unwrap_or(f64::NEG_INFINITY);
        match self {
            Self::Date => other.name.get(..16).cmp(&one.name.get(..16)),
            Self::Scenario => one.scenario.cmp(&other.scenario),
            Self::Planner => one.planner.cmp(&other.planner),
            Self::End => one.end.cmp(&other.end),
            Self::Coverage => number(other.reachable).total_cmp(&number(one.reachable)),
            Self::Time => number(other.mission_time_s).total_cmp(&number(one.mission_time_s)),
        }
    }
}

/// The review screen.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Review {
    /// The index of the selected run among those that pass the filter.
    pub selected: usize,
    /// The filter: words that must all occur in a listed run.
    pub filter: String,
    /// The sort order.
    pub sort: SortBy,
}

impl Review {
    /// The past runs that pass the filter, sorted; runs that rank equally stay in order of date.
    pub fn runs<'a>(&self, home: &'a Home) -> Vec<&'a PastRun> {
        let filter = self.filter.to_lowercase();
        let all = home.found.iter().flat_map(|found| &found.runs);
        let mut listed: Vec<&PastRun> =
            all.filter(|run| filter.split_whitespace().all(|word| contains(run, word))).collect();
        listed.sort_by(|one, other| self.sort.compare(one, other));
        listed
    }

    /// The selected run.
    pub fn run<'a>(&self, home: &'a Home) -> Option<&'a PastRun> {
        let listed = self.runs(home);
        listed.get(self.selected.min(listed.len().saturating_sub(1))).copied()
    }

    /// Moves the selection down by `by` runs.
    pub(crate) fn select(&mut self, home: &Home, by: isize) {
        let last = self.runs(home).len().saturating_sub(1);
        self.selected = self.selected.min(last).saturating_add_signed(by).min(last);
    }
}

fn contains(run: &PastRun, word: &str) -> bool {
    let texts = [&run.name, &run.scenario, &run.planner, &run.end];
    let all = texts.into_iter().chain(&run.remark).chain(&run.note);
    all.into_iter().any(|text| text.to_lowercase().contains(word))
}
