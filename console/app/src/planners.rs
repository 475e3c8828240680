//! `tankops planners` and `tankops check`: what was found, and what is wrong with it.

use crate::{
    accuracy::warn_of_clearance,
    config,
    failure::{BAD_INPUT, COMPLETE, bad_input},
    output::{pretty_json, say, say_line, warn_line},
};
use mission::{ParamInfo, ParamKind, PlannerChoice, PlannerInfo, TaskConfig};
use planner_host::{PluginDirs, Survey, SurveyedPlugin, WorkerCommand, parameter_problems, survey};
use scenario::{Scenario, Settings};
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};
use tui::Refused;

/// Planners that can be chosen.
pub(crate) fn found(plugins: &PluginDirs) -> Vec<PlannerInfo> {
    survey(plugins, &WorkerCommand::default()).planners().cloned().collect()
}

/// Planners that can be chosen, and plugins that are refused.
pub(crate) fn surveyed(plugins: &PluginDirs) -> (Vec<PlannerInfo>, Vec<Refused>) {
    let survey = survey(plugins, &WorkerCommand::default());
    let refused = survey.plugins.iter().filter_map(|plugin| {
        Some(Refused { plugin: file_name(&plugin.path), reason: plugin.refused.clone()? })
    });
    (survey.planners().cloned().collect(), refused.collect())
}

/// Makes sure, before anything is flown, that the planners of a scenario are among the known ones and take their
/// parameters.
///
/// # Errors
/// Every objection, with its place in the scenario.
pub(crate) fn check_choices(scenario: &Scenario, known: &[PlannerInfo]) -> anyhow::Result<()> {
    let mission = &scenario.mission;
    let fallback = mission.fallback.iter().map(|choice| ("planner.fallback", choice));
    let choices = std::iter::once(("planner", &mission.planner)).chain(fallback);
    let must_cover = matches!(mission.task, TaskConfig::Cover { .. });
    let objections: Vec<_> =
        choices.flat_map(|(section, choice)| objections(section, choice, known, must_cover)).collect();
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
pub(crate) fn choice_of<'a>(id: &str, known: &'a [PlannerInfo]) -> Result<&'a PlannerInfo, String> {
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

/// `tankops planners`.
pub(crate) fn list(plugins: &PluginDirs, json: bool) -> anyhow::Result<ExitCode> {
    let survey = survey(plugins, &WorkerCommand::default());
    say(&if json { pretty_json("the list", &survey)? } else { listing(&survey, plugins) })?;
    Ok(ExitCode::from(COMPLETE))
}

fn listing(survey: &Survey, plugins: &PluginDirs) -> String {
    let mut text: String = survey.plugins.iter().map(plugin_listing).collect();
    if survey.plugins.is_empty() {
        let places: Vec<String> = plugins.0.iter().map(|dir| format!("  {}\n", dir.display())).collect();
        text = format!("no plugins found in\n{}", places.concat());
    }
    text
}

fn plugin_listing(plugin: &SurveyedPlugin) -> String {
    let abi = plugin.abi.as_deref().map(|abi| format!("  ABI {abi}")).unwrap_or_default();
    let hash = plugin.sha256.get(..12).unwrap_or_default();
    let head = format!("{}{abi}  sha256 {hash}\n", plugin.path.display());
    let refused = plugin.refused.iter().map(|reason| format!("  REFUSED: {reason}\n"));
    let planners = plugin.planners.iter().map(planner_listing);
    let shadowed =
        plugin.shadowed.iter().map(|id| format!("  {id}  shadowed by a plugin that is found earlier\n"));
    std::iter::once(head).chain(refused).chain(planners).chain(shadowed).collect()
}

fn planner_listing(info: &PlannerInfo) -> String {
    let head = format!("  {} {}  {}\n", info.id, info.version, info.name);
    let about = (!info.about.is_empty()).then(|| format!("      {}\n", info.about));
    std::iter::once(head).chain(about).chain(info.parameters.iter().map(parameter_listing)).collect()
}

fn parameter_listing(info: &ParamInfo) -> String {
    let values = match &info.kind {
        ParamKind::Float { min, max, default } => format!("{default} ({min} to {max})"),
        ParamKind::Int { min, max, default } => format!("{default} ({min} to {max})"),
        ParamKind::Flag { default } => format!("{default}"),
        ParamKind::Choice { options, default } => format!("{default} ({})", options.join(", ")),
    };
    let live = if info.live { ", live" } else { "" };
    let unit = if info.unit.is_empty() { String::new() } else { format!(" {}", info.unit) };
    format!("      {:<18} {values}{unit}{live}\n", info.key)
}

/// `tankops check`.
pub(crate) fn check(files: &[PathBuf], plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let mut sound = true;
    for file in files {
        match check_file(file, plugins) {
            Ok(what) => say_line(&format!("ok: {}: {what}", file.display()))?,
            Err(why) => {
                sound = false;
                warn_line(why.trim_end());
            }
        }
    }
    Ok(ExitCode::from(if sound { COMPLETE } else { BAD_INPUT }))
}

fn check_file(file: &Path, plugins: &PluginDirs) -> Result<String, String> {
    if let Some(checked) = config::check(file) {
        return checked;
    }
    let is_plugin =
        file.extension().is_some_and(|end| ["so", "dylib", "dll"].iter().any(|known| end == *known));
    if is_plugin {
        return check_plugin(file);
    }
    let scenario = Scenario::read_with(file, &Settings::default()).map_err(|errors| errors.render())?;
    check_choices(&scenario, &found(plugins)).map_err(|error| error.to_string())?;
    warn_of_clearance(&scenario);
    Ok(format!("scenario {}, planner {}", scenario.name, scenario.mission.planner.id))
}

fn check_plugin(file: &Path) -> Result<String, String> {
    let error = |why: String| format!("error: {}: {why}", file.display());
    let checked = planner_host::check_plugin(file, &WorkerCommand::default());
    if let Some(reason) = checked.refused {
        return Err(error(reason));
    }
    let ids: Vec<&str> = checked.planners.iter().map(|info| info.id.as_str()).collect();
    Ok(format!("plugin with {}", ids.join(", ")))
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}
