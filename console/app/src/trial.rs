//! `tankops check PLUGIN --fly N`: what a planner must do, and how it flies beside the others.

use crate::output::pretty_json;
use conformance::Trial;
use flight::{
    failure::{COMPLETE, ENDED_OTHERWISE, bad_input},
    planners,
};
use mission::PlannerInfo;
use planner_host::{PluginDirs, SurveyedPlugin, WorkerCommand, check_plugin};
use report::print::say;
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

/// Tries every planner of some plugins in `n` random tanks from a seed on.
pub(crate) fn fly(
    files: &[PathBuf],
    plugins: &PluginDirs,
    tanks: (u64, u64),
    json: bool,
) -> anyhow::Result<ExitCode> {
    let mut trials = Vec::new();
    for file in files {
        let plugins = with_folder_of(file, plugins);
        let found = planners::found(&plugins).planners;
        for planner in planners_of(file, &plugins, &found)? {
            trials.push(Trial::of(&planner, &found, &plugins, tanks));
        }
    }
    let texts: Vec<String> = trials.iter().map(Trial::human).collect();
    say(&if json { pretty_json("what came of the flights", &trials)? } else { texts.join("\n") })?;
    let is_passed = trials.iter().all(Trial::is_passed);
    Ok(ExitCode::from(if is_passed { COMPLETE } else { ENDED_OTHERWISE }))
}

/// The folders of plugins, that of this file first.
fn with_folder_of(file: &Path, plugins: &PluginDirs) -> PluginDirs {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut plugins = plugins.clone();
    plugins.folders.insert(0, folder.to_owned());
    plugins
}

/// The planners of a plugin, each of which must be the one that is chosen by its id.
fn planners_of(file: &Path, plugins: &PluginDirs, found: &[PlannerInfo]) -> anyhow::Result<Vec<PlannerInfo>> {
    let refused = |why: String| bad_input(format!("{}: {why}", file.display()));
    let SurveyedPlugin { sha256, planners, refused: reason, .. } =
        check_plugin(file, &WorkerCommand::default(), plugins.requires_sandbox);
    if let Some(reason) = reason {
        return Err(refused(reason));
    }
    let is_hidden =
        |info: &&PlannerInfo| !found.iter().any(|found| found.id == info.id && found.sha256 == sha256);
    if let Some(hidden) = planners.iter().find(is_hidden) {
        return Err(refused(format!(
            "cannot be flown: its planner `{}` is not found in this folder; the file must be called libplanner_*.so (.dylib, \
             planner_*.dll), and no file before it may have a planner of this id",
            hidden.id
        )));
    }
    Ok(planners)
}
