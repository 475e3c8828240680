//! The contents of the home screen: scenarios, past runs, and problems on disk.

use super::{config::presets, desk::Tools, inbox::Outbox};
use flight::{planners::check_choices, scenarios};
use mission::{Severity, TaskConfig, clock};
use runs::Listed;
use scenario::{Scenario, Settings};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
    time::SystemTime,
};
use tui::{
    Msg, Source,
    model::{
        PastRun, ScenarioEntry,
        home::{Attention, Found},
    },
};
use world::Boundary;

/// The largest number of past runs shown: the newest ones.
const MOST_RUNS: usize = 1000;
/// The operator is warned if any of this many newest past runs ended badly.
const RECENT: usize = 20;

/// A scan of the disk. An unchanged file is not read again.
pub(super) struct Disk {
    tools: Tools,
    read: Mutex<BTreeMap<PathBuf, (Option<SystemTime>, ScenarioEntry)>>,
    /// The scenario files that were opened by their paths, wherever they are.
    opened: Mutex<BTreeSet<PathBuf>>,
}

impl Disk {
    /// Creates a scan that has not run yet.
    pub(super) fn new(tools: Tools) -> Self {
        Self { tools, read: Mutex::default(), opened: Mutex::default() }
    }

    /// Lists a scenario file from now on, even if it is in none of the folders.
    pub(super) fn list(&self, source: &Source) {
        // Standard input (`-`) is not a file that can be read again.
        if let Source::File(path) = source
            && let Ok(whole) = std::fs::canonicalize(path)
        {
            self.opened.lock().unwrap_or_else(PoisonError::into_inner).insert(whole);
        }
    }

    /// Scans the disk and reports to the screen.
    pub(super) fn look(&self) {
        let outbox: &Outbox = &self.tools.outbox;
        outbox.send(Msg::Presets(presets::load(&self.tools.planners.get().planners)));
        outbox.send(Msg::Found(Box::new(self.found())));
    }

    fn found(&self) -> Found {
        let Tools { logs, .. } = &self.tools;
        let scenarios = self.scenarios();
        let (runs, unreadable) = match runs::list(logs, &review::register()) {
            Ok(listed) => {
                let newest = listed.iter().rev().take(MOST_RUNS);
                (newest.map(|run| past_run(run, &scenarios)).collect(), None)
            }
            Err(error) => (Vec::new(), Some(error.to_string())),
        };
        let mut attention = attention(&runs, &scenarios);
        attention.extend(self.tools.config.attention.clone());
        attention.extend(unreadable.map(|why| point(Severity::Crit, "LOGS", why)));
        attention.push(match runs::check_logs(logs) {
            Ok(()) => point(Severity::Info, "ok", format!("logs folder writable: {}", logs.display())),
            Err(error) => point(Severity::Crit, "LOGS", error.to_string()),
        });
        attention.sort_by_key(|point| std::cmp::Reverse(point.severity));
        Found {
            scenarios,
            runs,
            logs: logs.display().to_string(),
            free_bytes: runs::free_bytes(logs),
            attention,
        }
    }

    /// The scenarios in the folders and those that were opened by their paths, by name; the demo is always included, wherever
    /// the console was started.
    fn scenarios(&self) -> Vec<ScenarioEntry> {
        let folders = &self.tools.config.scenarios;
        let mut files: Vec<PathBuf> = folders
            .iter()
            .filter_map(|folder| std::fs::read_dir(folder).ok())
            .flatten()
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
            .collect();
        let listed: BTreeSet<PathBuf> =
            files.iter().filter_map(|file| std::fs::canonicalize(file).ok()).collect();
        let opened = self.opened.lock().unwrap_or_else(PoisonError::into_inner);
        files.extend(opened.difference(&listed).cloned());
        files.sort();
        let mut entries: Vec<ScenarioEntry> = files.iter().map(|file| self.entry(file)).collect();
        if !entries.iter().any(|entry| entry.name == "demo") {
            entries.push(entry_of(
                Source::Demo,
                "demo",
                scenarios::demo(&Settings::default()).map_err(|error| error.to_string()),
                self,
            ));
        }
        entries.sort_by(|one, other| one.name.cmp(&other.name));
        entries
    }

    fn entry(&self, file: &Path) -> ScenarioEntry {
        let changed = std::fs::metadata(file).and_then(|data| data.modified()).ok();
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((before, entry)) =
            read.get(file).filter(|(before, _)| before.is_some() && *before == changed)
        {
            debug_assert_eq!(*before, changed);
            return entry.clone();
        }
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        let source = Source::File(file.display().to_string());
        // Reading a pipe could block forever.
        let scenario = if file.is_file() {
            scenarios::read(file, &Settings::default()).map_err(|error| error.to_string())
        } else {
            Err(format!("{}: not a regular file", file.display()))
        };
        let entry = entry_of(source, &name, scenario, self);
        read.insert(file.to_owned(), (changed, entry.clone()));
        entry
    }
}

fn entry_of(source: Source, name: &str, scenario: Result<Scenario, String>, disk: &Disk) -> ScenarioEntry {
    let checked = scenario.and_then(|scenario| {
        let problem = check_choices(&scenario, &disk.tools.planners.get()).err();
        problem.map_or(Ok(scenario), |error| Err(error.to_string()))
    });
    match checked {
        Ok(scenario) => ScenarioEntry {
            source,
            name: scenario.name.clone(),
            about: scenario.about.clone(),
            task: task(&scenario.mission.task).to_owned(),
            tank: tank(&scenario.sim.world.boundary),
            planner: scenario.mission.planner.id.clone(),
            expected: scenario.expect.words(),
            problem: None,
            world: Some(Box::new(scenario.sim.world.as_drawn())),
            mission: Some(Box::new(scenario.mission)),
        },
        Err(problem) => ScenarioEntry {
            source,
            name: name.to_owned(),
            about: String::new(),
            task: String::new(),
            tank: String::new(),
            planner: String::new(),
            expected: String::new(),
            problem: Some(problem),
            world: None,
            mission: None,
        },
    }
}

fn task(task: &TaskConfig) -> &'static str {
    match task {
        TaskConfig::Goto { .. } => "goto",
        TaskConfig::Follow { .. } => "follow",
        TaskConfig::Cover { .. } => "cover",
        TaskConfig::Survey { .. } => "survey",
    }
}

fn tank(boundary: &Boundary) -> String {
    match boundary {
        Boundary::Circle { radius_m } => format!("Ø{:.0} m", 2.0 * radius_m),
        Boundary::Polygon { .. } => {
            let (low, high) = boundary.bounds();
            format!("{:.0}×{:.0} m", high.x - low.x, high.y - low.y)
        }
    }
}

fn past_run(listed: &Listed, scenarios: &[ScenarioEntry]) -> PastRun {
    let began = runs::began(&listed.name);
    // A mission that does not scan passes over floor, but that is not its result.
    let entry = scenarios.iter().find(|entry| Some(&entry.name) == listed.scenario.as_ref());
    let scans = entry.is_none_or(|entry| entry.task.is_empty() || entry.task == "cover");
    PastRun {
        name: listed.name.clone(),
        began: began.map(runs::utc_day_minute).unwrap_or_default(),
        began_unix_s: began
            .and_then(|began| began.duration_since(SystemTime::UNIX_EPOCH).ok())
            .map(|since| since.as_secs_f64()),
        scenario: listed.scenario.clone().unwrap_or_default(),
        planner: listed.planner.clone().unwrap_or_default(),
        end: listed.end.clone(),
        mission_time_s: listed.mission_time_s,
        reachable: listed.coverage_reachable.filter(|_| scans),
        verified: listed.verified.clone(),
        note: listed.note.clone(),
        remark: listed.remark.clone(),
        bookmarks: listed.bookmarks,
    }
}

/// What to do with a run whose console was killed.
const NEXT_AFTER_CRASH: &str = ". `tankops recover` closes the run for a signature";

fn attention(runs: &[PastRun], scenarios: &[ScenarioEntry]) -> Vec<Attention> {
    let bad_ends = ["CRASHED", "RECORDING FAILED", "UNREADABLE"];
    let bad_runs = runs.iter().take(RECENT).filter(|run| bad_ends.contains(&run.end.as_str())).map(|run| {
        let note = run.note.clone().unwrap_or_default();
        let what = if run.scenario.is_empty() {
            run.name.clone()
        } else {
            format!("{} {}", run.scenario, run.began)
        };
        let text = if run.end == "CRASHED" {
            let kept =
                run.mission_time_s.map_or_else(String::new, |t_s| format!(" kept to T+{};", clock(t_s)));
            format!("{what}:{kept} re-scan the rest (:rescan); run {}: {note}{NEXT_AFTER_CRASH}", run.name)
        } else {
            format!("{what}: {note} (run {})", run.name)
        };
        Attention { run: Some(run.name.clone()), ..point(Severity::Warn, &run.end, text) }
    });
    let invalid = scenarios.iter().filter_map(|entry| {
        let problem = entry.problem.as_ref()?;
        let line = problem.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
        Some(point(Severity::Watch, "INVALID", format!("{}: {line}", entry.name)))
    });
    bad_runs.chain(invalid).collect()
}

fn point(severity: Severity, kind: &str, text: String) -> Attention {
    Attention { severity, kind: kind.to_owned(), text, run: None }
}
