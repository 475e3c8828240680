//! What there is to open: scenarios, past runs, and what is wrong with any of it.

use super::live::Source;
use mission::Severity;
use serde::{Deserialize, Serialize};

/// A scenario that can be opened, or why it cannot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScenarioEntry {
    /// Where it comes from.
    pub source: Source,
    /// Its name.
    pub name: String,
    /// What it shows, for people; may be empty.
    pub about: String,
    /// `goto`, `follow` or `cover`.
    pub task: String,
    /// Form and size of the tank, such as `Ø12 m`.
    pub tank: String,
    /// Id of its planner.
    pub planner: String,
    /// How it is expected to end, by its own bounds; empty if it has none.
    pub expected: String,
    /// Why it cannot be opened, with file, line and key.
    pub problem: Option<String>,
}

/// A past run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PastRun {
    /// Name of its folder.
    pub name: String,
    /// When it began, UTC, as its name says; empty if it does not.
    pub began: String,
    /// Name of its scenario; empty if it is not known.
    pub scenario: String,
    /// Id of the planner that drove first; empty if it is not known.
    pub planner: String,
    /// `complete`, `stuck`, …, `RUNNING`, `CRASHED`, `RECOVERED`, `RECORDING FAILED` or `UNREADABLE`.
    pub end: String,
    /// Mission time that passed, seconds.
    pub mission_time_s: Option<f64>,
    /// Scanned share of the reachable floor; `None` for missions that are not to scan.
    pub reachable: Option<f64>,
    /// What is wrong with it.
    pub note: Option<String>,
    /// What people remark about it.
    pub remark: Option<String>,
    /// How many bookmarks people have set in it.
    pub bookmarks: usize,
}

/// Something that the operator should know before a mission is opened.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Attention {
    /// How much it asks of the operator; INFO is all right.
    pub severity: Severity,
    /// A word for its kind, such as `REFUSED`.
    pub kind: String,
    /// What, as a sentence.
    pub text: String,
}

/// What was found on the disk.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Found {
    /// Scenarios, by name.
    pub scenarios: Vec<ScenarioEntry>,
    /// Past runs, the newest first.
    pub runs: Vec<PastRun>,
    /// The folder of runs.
    pub logs: String,
    /// Space left there, bytes; `None` if the system does not say.
    pub free_bytes: Option<u64>,
    /// What is wrong, and what was checked and is all right.
    pub attention: Vec<Attention>,
}

/// A list of the home screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum HomeList {
    /// Scenarios.
    #[default]
    Scenarios,
    /// Past runs.
    Runs,
}

/// The home screen.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Home {
    /// What was found on the disk; `None` as long as it is being looked at for the first time.
    pub found: Option<Found>,
    /// The list that takes the arrow keys.
    pub list: HomeList,
    /// The selected scenario, among those that pass the filter.
    pub scenario: usize,
    /// The selected run, among those that pass the filter.
    pub run: usize,
    /// Text that the names in the lists contain.
    pub filter: String,
}

impl Home {
    /// The scenarios that pass the filter.
    pub fn scenarios(&self) -> Vec<&ScenarioEntry> {
        let all = self.found.iter().flat_map(|found| &found.scenarios);
        all.filter(|entry| self.passes(&[&entry.name, &entry.task, &entry.planner])).collect()
    }

    /// The past runs that pass the filter.
    pub fn runs(&self) -> Vec<&PastRun> {
        let all = self.found.iter().flat_map(|found| &found.runs);
        all.filter(|run| self.passes(&[&run.name, &run.end])).collect()
    }

    fn passes(&self, texts: &[&str]) -> bool {
        let filter = self.filter.to_lowercase();
        filter.is_empty() || texts.iter().any(|text| text.to_lowercase().contains(&filter))
    }

    /// How the newest run of a scenario ended.
    pub fn last_end(&self, scenario: &str) -> Option<&PastRun> {
        self.found.as_ref()?.runs.iter().find(|run| run.scenario == scenario)
    }

    /// Selects another line of the list that takes the arrow keys, so many further down.
    pub(crate) fn select(&mut self, by: isize) {
        let (lines, selected) = match self.list {
            HomeList::Scenarios => (self.scenarios().len(), &mut self.scenario),
            HomeList::Runs => (self.runs().len(), &mut self.run),
        };
        *selected = selected.saturating_add_signed(by).min(lines.saturating_sub(1));
    }
}
