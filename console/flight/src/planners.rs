//! The planners that there are, and whether a scenario can be flown with them.

use crate::failure::bad_input;
use mission::{PlannerChoice, PlannerInfo, TaskConfig};
use planner_host::{PluginDirs, WorkerCommand, check_descriptors, find_planners, parameter_problems, survey};
use scenario::Scenario;

/// Planners that can be chosen.
pub fn found(plugins: &PluginDirs) -> Vec<PlannerInfo> {
    survey(plugins, &WorkerCommand::default()).planners().cloned().collect()
}

/// Makes sure, before anything is flown, that the planners of a scenario are there and take their parameters. Only the plugins
/// that may have them are looked at; all of them if something is wrong, to say what there is instead.
///
/// # Errors
/// Every objection, with its place in the scenario; or the machine lets no planner run.
pub fn check_installed(scenario: &Scenario, plugins: &PluginDirs) -> anyhow::Result<()> {
    check_descriptors().map_err(anyhow::Error::msg)?;
    let ids: Vec<&str> = chosen(scenario).map(|(_, choice)| choice.id.as_str()).collect();
    let known = find_planners(&ids, plugins, &WorkerCommand::default());
    check_choices(scenario, &known).or_else(|_| check_choices(scenario, &found(plugins)))
}

/// The planners of a scenario, with the sections that name them.
fn chosen(scenario: &Scenario) -> impl Iterator<Item = (&'static str, &PlannerChoice)> {
    let mission = &scenario.mission;
    let fallback = mission.fallback.iter().map(|choice| ("planner.fallback", choice));
    std::iter::once(("planner", &mission.planner)).chain(fallback)
}

/// Makes sure, before anything is flown, that the planners of a scenario are among the known ones and take their
/// parameters.
///
/// # Errors
/// Every objection, with its place in the scenario.
pub fn check_choices(scenario: &Scenario, known: &[PlannerInfo]) -> anyhow::Result<()> {
    let must_cover = matches!(scenario.mission.task, TaskConfig::Cover { .. });
    let objections: Vec<_> = chosen(scenario)
        .flat_map(|(section, choice)| objections(section, choice, known, must_cover))
        .collect();
    if objections.is_empty() { Ok(()) } else { Err(bad_input(scenario.refused(objections).render())) }
}

fn objections(
    section: &str,
    choice: &PlannerChoice,
    known: &[PlannerInfo],
    must_cover: bool,
) -> Vec<(String, String)> {
    let at = |key: String| format!("{section}.parameters.{key}");
    match choice_of(&choice.id, known) {
        Err(message) => vec![(format!("{section}.id"), message)],
        Ok(info) if let Some(why) = info.why_no_coverage().filter(|_| must_cover) => {
            let ids: Vec<&str> =
                known.iter().filter(|info| info.covers).map(|info| info.id.as_str()).collect();
            let who = if ids.is_empty() {
                "none that was found does".into()
            } else {
                format!("these do: {}", ids.join(", "))
            };
            vec![(format!("{section}.id"), format!("planner `{}` {why}; {who}", info.id))]
        }
        Ok(info) => {
            let problems = parameter_problems(info, &choice.parameters);
            problems.into_iter().map(|(key, message)| (at(key), message)).collect()
        }
    }
}

/// The planner of this id.
///
/// # Errors
/// One sentence with what there is.
pub fn choice_of<'a>(id: &str, known: &'a [PlannerInfo]) -> Result<&'a PlannerInfo, String> {
    known.iter().find(|info| info.id == id).ok_or_else(|| {
        let ids: Vec<&str> = known.iter().map(|info| info.id.as_str()).collect();
        let has = if ids.is_empty() {
            "no planner was found at all".into()
        } else {
            format!("found: {}", ids.join(", "))
        };
        format!("there is no planner `{id}`; {has}; `tankops planners` shows where they are searched for")
    })
}
