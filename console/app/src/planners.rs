//! `tankops planners` and `tankops check`: list the plugins found, and problems in files.

use crate::accuracy::warn_of_positions;
use command::json::pretty_json;
use flight::{
    failure::{BAD_INPUT, COMPLETE, is_input},
    planners::{self, check_installed},
};
use interactive::config;
use mission::{ParamInfo, ParamKind, PlannerInfo};
use planner_host::{PluginDirs, Survey, SurveyedPlugin, WorkerCommand, survey};
use report::print::{say, say_line, warn_line};
use scenario::{Scenario, Settings};
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

/// Runs `tankops planners`.
pub(crate) fn list(plugins: &PluginDirs, json: bool) -> anyhow::Result<ExitCode> {
    let survey = survey(plugins, &WorkerCommand::default());
    say(&if json { pretty_json("the list", &survey)? } else { listing(&survey, plugins) })?;
    Ok(ExitCode::from(COMPLETE))
}

fn listing(survey: &Survey, plugins: &PluginDirs) -> String {
    let mut text: String = survey.plugins.iter().map(plugin_listing).collect();
    if survey.plugins.is_empty() {
        let places: Vec<String> =
            plugins.folders.iter().map(|dir| format!("  {}\n", dir.display())).collect();
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
    let shadowed = plugin.shadowed.iter().map(|id| format!("  {id}  shadowed by a plugin found earlier\n"));
    std::iter::once(head).chain(refused).chain(planners).chain(shadowed).collect()
}

fn planner_listing(info: &PlannerInfo) -> String {
    let sandbox = info.sandbox.as_ref().map(|sandbox| format!("  sandbox: {sandbox}")).unwrap_or_default();
    let head = format!("  {} {}  {}{sandbox}\n", info.id, info.version, info.name);
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

/// Warns if more than one plugin contains a planner of the scenario.
pub(crate) fn warn_of_shadowed(scenario: &Scenario, plugins: &PluginDirs) {
    for sentence in &planners::shadowed(scenario, plugins) {
        warn_line(sentence);
    }
}

/// Runs `tankops check`.
pub(crate) fn check(files: &[PathBuf], plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let mut sound = true;
    for file in files {
        match check_file(file, plugins)? {
            Ok(what) => say_line(&format!("ok: {}: {what}", file.display()))?,
            Err(why) => {
                sound = false;
                warn_line(why.trim_end());
            }
        }
    }
    Ok(ExitCode::from(if sound { COMPLETE } else { BAD_INPUT }))
}

/// Whether a file has the name of a library; only such a file is checked as a plugin.
pub(crate) fn is_plugin(file: &Path) -> bool {
    file.extension().is_some_and(|end| ["so", "dylib", "dll"].iter().any(|known| end == *known))
}

/// A description of the file, or of the problems in it.
///
/// # Errors
/// This machine cannot run any planner.
fn check_file(file: &Path, plugins: &PluginDirs) -> anyhow::Result<Result<String, String>> {
    if let Some(checked) = config::check(file) {
        return Ok(checked);
    }
    if is_plugin(file) {
        return check_plugin(file, plugins);
    }
    let scenario = match Scenario::read_with(file, &Settings::default()) {
        Ok(scenario) => scenario,
        Err(errors) => return Ok(Err(errors.render())),
    };
    match check_installed(&scenario, plugins) {
        Ok(()) => {}
        Err(error) if is_input(&error) => return Ok(Err(error.to_string())),
        Err(error) => return Err(error),
    }
    warn_of_positions(&scenario);
    warn_of_shadowed(&scenario, plugins);
    Ok(Ok(format!("scenario {}, planner {}", scenario.name, scenario.mission.planner.id)))
}

fn check_plugin(file: &Path, plugins: &PluginDirs) -> anyhow::Result<Result<String, String>> {
    let error = |why: String| Err(format!("error: {}: {why}", file.display()));
    let checked = planner_host::check_plugin(file, &WorkerCommand::default(), plugins.requires_sandbox);
    let checked = checked.map_err(anyhow::Error::msg)?;
    if let Some(reason) = checked.refused {
        return Ok(error(reason));
    }
    let ids: Vec<&str> = checked.planners.iter().map(|info| info.id.as_str()).collect();
    Ok(Ok(format!("plugin; planners: {}", ids.join(", "))))
}
