//! The installed planners, and whether a scenario can be run with them.

use crate::failure::bad_input;
use anyhow::anyhow;
use mission::{PlannerChoice, PlannerInfo, RefusedPlugin, TaskConfig};
use planner_host::{PluginDirs, Survey, Surveyor, WorkerCommand, check_limits, parameter_problems, survey};
use scenario::Scenario;
use std::path::PathBuf;

/// The planners to choose from.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// Planners that can be chosen.
    pub planners: Vec<PlannerInfo>,
    /// Plugins that cannot be chosen.
    pub refused: Vec<RefusedPlugin>,
}

impl From<&Survey> for Found {
    fn from(survey: &Survey) -> Self {
        Self { planners: survey.planners().cloned().collect(), refused: survey.refused().collect() }
    }
}

/// Examines every plugin.
pub fn found(plugins: &PluginDirs) -> Found {
    Found::from(&survey(plugins, &WorkerCommand::default()))
}

/// Checks, before a flight, that the planners of a scenario are installed and accept their parameters. Only the plugins
/// that may contain these planners are examined; if something is wrong, all plugins are examined in order to list the
/// available planners.
///
/// # Errors
/// Every objection, with its place in the scenario; or the reason why no planner can run on this machine.
pub fn check_installed(scenario: &Scenario, plugins: &PluginDirs) -> anyhow::Result<()> {
    check_limits(plugins).map_err(anyhow::Error::msg)?;
    let ids: Vec<&str> = chosen(scenario).map(|(_, choice)| choice.id.as_str()).collect();
    let worker = WorkerCommand::default();
    let surveyor = Surveyor::new(plugins, &worker);
    let chosen = Found { planners: surveyor.find(&ids), refused: Vec::new() };
    check_choices(scenario, &chosen).or_else(|_| {
        let found = Found::from(&surveyor.survey());
        match surveyor.no_worker() {
            Some(why) => Err(anyhow!("a planner plugin {why}")),
            None => check_choices(scenario, &found),
        }
    })
}

/// A message for each planner of the scenario that is contained in more than one plugin; the message states which
/// plugin is used.
pub fn shadowed(scenario: &Scenario, plugins: &PluginDirs) -> Vec<String> {
    let ids: Vec<&str> = chosen(scenario).map(|(_, choice)| choice.id.as_str()).collect();
    let worker = WorkerCommand::default();
    let twice = Surveyor::new(plugins, &worker).shadowed(&ids);
    let sentence = |(id, taken, other): (String, PathBuf, PathBuf)| {
        let (taken, other) = (taken.display(), other.display());
        format!("planner {id} is taken from {taken}; the one in {other} is ignored")
    };
    twice.into_iter().map(sentence).collect()
}

/// The planners of a scenario (a survey has none), each with the section of the scenario that names it.
fn chosen(scenario: &Scenario) -> impl Iterator<Item = (&'static str, &PlannerChoice)> {
    let mission = &scenario.mission;
    let fallback = mission.fallback.iter().map(|choice| ("planner.fallback", choice));
    let planner = (!mission.task.is_survey()).then_some(("planner", &mission.planner));
    planner.into_iter().chain(fallback)
}

/// Checks, before a flight, that the planners of a scenario are among those found and accept their parameters.
///
/// # Errors
/// Every objection, with its place in the scenario.
pub fn check_choices(scenario: &Scenario, found: &Found) -> anyhow::Result<()> {
    let task = &scenario.mission.task;
    let objections: Vec<_> =
        chosen(scenario).flat_map(|(section, choice)| objections(section, choice, found, task)).collect();
    if objections.is_empty() { Ok(()) } else { Err(bad_input(scenario.refused(objections).render())) }
}

fn objections(
    section: &str,
    choice: &PlannerChoice,
    found: &Found,
    task: &TaskConfig,
) -> Vec<(String, String)> {
    let at = |key: String| format!("{section}.parameters.{key}");
    match choice_of(&choice.id, found) {
        Err(message) => vec![(format!("{section}.id"), message)],
        Ok(info) if let Some(why) = why_unsuited(info, task) => {
            let ids: Vec<&str> =
                found.planners.iter().filter(|info| info.covers).map(|info| info.id.as_str()).collect();
            let who = if ids.is_empty() {
                "no installed planner does".into()
            } else {
                format!("planners that do: {}", ids.join(", "))
            };
            vec![(format!("{section}.id"), format!("planner `{}` {why}; {who}", info.id))]
        }
        Ok(info) => {
            let problems = parameter_problems(info, &choice.parameters);
            problems.into_iter().map(|(key, message)| (at(key), message)).collect()
        }
    }
}

/// Planners for coverage, with those that drive the shortest paths first (`tankops reproduce coverage-suite`).
const FOR_COVERAGE: [&str; 3] = ["tether-safe", "hull-partition", "boustrophedon"];

/// The default planner in scenarios for coverage missions.
pub const COVERAGE_PLANNER: &str = FOR_COVERAGE[0];

/// Why a planner does not suit a task; `None` if it does.
pub fn why_unsuited(info: &PlannerInfo, task: &TaskConfig) -> Option<&'static str> {
    info.why_no_coverage().filter(|_| matches!(task, TaskConfig::Cover { .. }))
}

/// The best available planner for a coverage mission: a well-known one if possible, otherwise any that covers floor.
pub fn suited_to_coverage(found: &Found) -> Option<&PlannerInfo> {
    let covering = || found.planners.iter().filter(|info| info.covers);
    let rank = |info: &&PlannerInfo| FOR_COVERAGE.iter().position(|id| *id == info.id).unwrap_or(usize::MAX);
    covering().min_by_key(rank)
}

/// Finds the planner with this id.
///
/// # Errors
/// The reason why its plugin was refused, or a sentence that lists the available planners.
pub fn choice_of<'a>(id: &str, found: &'a Found) -> Result<&'a PlannerInfo, String> {
    found.planners.iter().find(|info| info.id == id).ok_or_else(|| {
        if let Some(RefusedPlugin { plugin, reason }) =
            found.refused.iter().find(|refused| refused.is_named_after(id))
        {
            return format!("planner `{id}` cannot be chosen: plugin {plugin} is refused: {reason}");
        }
        let ids: Vec<&str> = found.planners.iter().map(|info| info.id.as_str()).collect();
        let has = if ids.is_empty() {
            "no planners were found".into()
        } else {
            format!("found: {}", ids.join(", "))
        };
        let refused: Vec<String> = found
            .refused
            .iter()
            .map(|RefusedPlugin { plugin, reason }| format!("; plugin {plugin} is refused: {reason}"))
            .collect();
        let refused = refused.concat();
        format!(
            "there is no planner `{id}`; {has}{refused}; `tankops planners` shows the folders that are \
             searched"
        )
    })
}
