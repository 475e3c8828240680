//! The scenarios and past runs that can be opened, and any problems with them.

use super::glimpse::Glimpses;
use super::live::Source;
use mission::{MissionConfig, Severity};
use serde::{Deserialize, Serialize};
use world::World;

/// A scenario and, if it cannot be opened, the reason.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScenarioEntry {
    /// The source of the scenario.
    pub source: Source,
    /// The name of the scenario.
    pub name: String,
    /// The description of the scenario; may be empty.
    pub about: String,
    /// `goto`, `follow` or `cover`.
    pub task: String,
    /// Shape and size of the tank, such as `Ø12 m`.
    pub tank: String,
    /// The id of the planner.
    pub planner: String,
    /// The outcome expected by the scenario's own bounds; empty if it has none.
    pub expected: String,
    /// Why the scenario cannot be opened, with file, line and key.
    pub problem: Option<String>,
    /// The tank as drawn; `None` if the scenario cannot be opened.
    #[serde(default)]
    pub world: Option<Box<World>>,
    /// The settings of the mission; `None` if the scenario cannot be opened.
    #[serde(default)]
    pub mission: Option<Box<MissionConfig>>,
}

impl ScenarioEntry {
    /// The reason why the scenario cannot be opened, in one line without the path of its file: `line 14: unknown key`.
    pub fn briefly(&self) -> Option<String> {
        let problem = self.problem.as_ref()?;
        let line = problem.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or_default();
        let line = line.strip_prefix("error: ").unwrap_or(line);
        let (Source::File(path), Some(rest)) =
            (&self.source, line.split_once(".toml:").map(|(_, rest)| rest))
        else {
            return Some(line.to_owned());
        };
        let is_of_file = line.starts_with(path.as_str());
        let place = rest.split_once(": ").filter(|_| is_of_file);
        let numbered = place.and_then(|(place, why)| {
            let number =
                place.split(':').next().filter(|number| number.bytes().all(|b| b.is_ascii_digit()))?;
            Some(format!("line {number}: {why}"))
        });
        Some(numbered.unwrap_or_else(|| line.to_owned()))
    }
}

/// A past run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PastRun {
    /// The name of the run's folder.
    pub name: String,
    /// When the run began, UTC, taken from the folder's name: `22 Nov 04:01`; empty if the name contains no time.
    pub began: String,
    /// The same moment, seconds since 1970.
    #[serde(default)]
    pub began_unix_s: Option<f64>,
    /// The name of the scenario; empty if unknown.
    pub scenario: String,
    /// The id of the first planner; empty if unknown.
    pub planner: String,
    /// `complete`, `stuck`, …, `RUNNING`, `CRASHED`, `RECOVERED`, `RECORDING FAILED` or `UNREADABLE`.
    pub end: String,
    /// The mission time of the run, seconds.
    pub mission_time_s: Option<f64>,
    /// Scanned share of the reachable floor; `None` for missions without scanning.
    pub reachable: Option<f64>,
    /// When the run was verified, UTC; `None` if it was not, or if its journal has changed since.
    #[serde(default)]
    pub verified: Option<String>,
    /// What is wrong with the run.
    pub note: Option<String>,
    /// The remark that was written about the run.
    pub remark: Option<String>,
    /// The number of bookmarks set in the run.
    pub bookmarks: usize,
}

/// Information that the operator should have before opening a mission.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Attention {
    /// The severity; INFO means that all is well.
    pub severity: Severity,
    /// A word for the kind of information, such as `REFUSED`.
    pub kind: String,
    /// The information, as a sentence.
    pub text: String,
    /// The name of the past run that it is about, if it is about one.
    #[serde(default)]
    pub run: Option<String>,
}

/// The contents of the disk.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Found {
    /// The scenarios, by name.
    pub scenarios: Vec<ScenarioEntry>,
    /// The past runs, newest first.
    pub runs: Vec<PastRun>,
    /// The folder that holds the runs.
    pub logs: String,
    /// The space left in that folder, bytes; `None` if the system does not report it.
    pub free_bytes: Option<u64>,
    /// Problems, and checks that passed.
    pub attention: Vec<Attention>,
}

/// A list on the home screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum HomeList {
    /// Scenarios.
    #[default]
    Scenarios,
    /// Past runs.
    Runs,
    /// Problems, and checks that passed.
    Attention,
}

impl HomeList {
    /// The lists, in Tab order.
    pub const ALL: [Self; 3] = [Self::Scenarios, Self::Runs, Self::Attention];

    /// The list that is `by` places further on in Tab order.
    #[must_use]
    pub fn turned(self, by: isize) -> Self {
        let at = (self as isize + by).rem_euclid(Self::ALL.len() as isize);
        Self::ALL[at as usize]
    }
}

/// The home screen.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Home {
    /// The contents of the disk; `None` until the first scan is complete.
    pub found: Option<Found>,
    /// The list that responds to the arrow keys.
    pub list: HomeList,
    /// The index of the selected scenario among those that pass the filter.
    pub scenario: usize,
    /// The index of the selected run among those that pass the filter.
    pub run: usize,
    /// The index of the selected item in the attention list.
    #[serde(default)]
    pub attention: usize,
    /// Whether the whole text of the selected attention item is shown.
    #[serde(default)]
    pub is_read: bool,
    /// The filter: words that must all occur in a listed scenario or run.
    pub filter: String,
    /// Details of the past runs that were selected.
    #[serde(default)]
    pub glimpses: Glimpses,
}

impl Home {
    /// The scenarios that pass the filter.
    pub fn scenarios(&self) -> Vec<&ScenarioEntry> {
        let all = self.found.iter().flat_map(|found| &found.scenarios);
        let last = |entry: &ScenarioEntry| self.last_end(&entry.name).map_or("", |run| run.end.as_str());
        all.filter(|entry| {
            let state = if entry.problem.is_some() { "INVALID" } else { last(entry) };
            self.passes(&[&entry.name, &entry.task, &entry.planner, state])
        })
        .collect()
    }

    /// The past runs that pass the filter.
    pub fn runs(&self) -> Vec<&PastRun> {
        let all = self.found.iter().flat_map(|found| &found.runs);
        all.filter(|run| {
            let words = run.remark.as_deref().unwrap_or_default();
            self.passes(&[&run.name, &run.scenario, &run.planner, &run.end, words])
        })
        .collect()
    }

    /// Whether every word of the filter occurs in one of the texts.
    fn passes(&self, texts: &[&str]) -> bool {
        let filter = self.filter.to_lowercase();
        filter.split_whitespace().all(|word| texts.iter().any(|text| text.to_lowercase().contains(word)))
    }

    /// The item of the attention list that is selected.
    pub(crate) fn selected_attention(&self) -> Option<&Attention> {
        let all = &self.found.as_ref()?.attention;
        all.get(self.attention.min(all.len().checked_sub(1)?))
    }

    /// The newest run of a scenario, which shows how the scenario last ended.
    pub fn last_end(&self, scenario: &str) -> Option<&PastRun> {
        self.found.as_ref()?.runs.iter().find(|run| run.scenario == scenario)
    }

    /// The selected scenario.
    pub fn selected_scenario(&self) -> Option<&ScenarioEntry> {
        self.scenarios().get(self.scenario).copied()
    }

    /// The selected past run.
    pub fn selected_run(&self) -> Option<&PastRun> {
        self.runs().get(self.run).copied()
    }

    /// Moves the selection down by `by` lines in the list that responds to the arrow keys.
    pub(crate) fn select(&mut self, by: isize) {
        let points = self.found.as_ref().map_or(0, |found| found.attention.len());
        let (lines, selected) = match self.list {
            HomeList::Scenarios => (self.scenarios().len(), &mut self.scenario),
            HomeList::Runs => (self.runs().len(), &mut self.run),
            HomeList::Attention => (points, &mut self.attention),
        };
        *selected = selected.saturating_add_signed(by).min(lines.saturating_sub(1));
    }
}
