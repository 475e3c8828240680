//! `tankops check PLUGIN --fly N`: checks the planner contract, and compares a planner with the installed ones.

use crate::output::write_file;
use command::json::pretty_json;
use conformance::{Lost, Others, Trial};
use flight::{
    failure::{COMPLETE, ENDED_OTHERWISE, bad_input, not_written},
    planners,
};
use mission::PlannerInfo;
use planner_host::{PluginDirs, SurveyedPlugin, WorkerCommand, check_plugin};
use report::print::{say, warn_line};
use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

/// Tries every planner in these plugins in `n` random tanks, beginning with a seed; `keep` is a folder for the failed
/// tanks.
pub(crate) fn fly(
    files: &[PathBuf],
    plugins: &PluginDirs,
    tanks: (u64, u64),
    json: bool,
    keep: Option<&Path>,
) -> anyhow::Result<ExitCode> {
    if let Some(file) = files.iter().find(|file| file.extension().is_some_and(|end| end == "toml")) {
        return Err(bad_input(format!(
            "{}: --fly tests plugins; to run a scenario, use `tankops run {0}`",
            file.display()
        )));
    }
    let mut trials = Vec::new();
    let shipped: Vec<String> =
        planners::found(&PluginDirs::standard(&[])).planners.into_iter().map(|info| info.id).collect();
    for file in files {
        let plugins = with_folder_of(file, plugins);
        let found = planners::found(&plugins).planners;
        for planner in planners_of(file, &plugins, &found)? {
            let others = Others { found: &found, shipped: &shipped };
            trials.extend(Trial::all_of(&planner, others, &plugins, tanks));
        }
    }
    let texts: Vec<String> = trials.iter().map(Trial::human).collect();
    say(&if json { pretty_json("the results of the trial runs", &trials)? } else { texts.join("\n") })?;
    if let Some(folder) = keep {
        let lost: Vec<Lost> = trials.iter().flat_map(Trial::lost).collect();
        keep_lost(folder, &lost)?;
    }
    let is_passed = trials.iter().all(Trial::is_passed);
    Ok(ExitCode::from(if is_passed { COMPLETE } else { ENDED_OTHERWISE }))
}

/// Writes the failed tanks as scenarios, and lists these files.
fn keep_lost(folder: &Path, lost: &[Lost]) -> anyhow::Result<()> {
    fs::create_dir_all(folder).map_err(|error| not_written("--keep", &error, folder))?;
    for Lost { name, scenario } in lost {
        let file = folder.join(format!("{name}.toml"));
        // The same tank always has the same text, so a different text has been edited by a person.
        if fs::read_to_string(&file).is_ok_and(|there| there != *scenario) {
            return Err(bad_input(format!(
                "--keep {}: already exists and was edited; choose another folder",
                file.display()
            )));
        }
        write_file("--keep", &file, scenario)?;
        warn_line(&format!("kept {}", file.display()));
    }
    if lost.is_empty() {
        warn_line("no planner failed in any tank: nothing was written");
    }
    Ok(())
}

/// The plugin folders, beginning with the folder of this file.
fn with_folder_of(file: &Path, plugins: &PluginDirs) -> PluginDirs {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut plugins = plugins.clone();
    plugins.folders.insert(0, folder.to_owned());
    plugins
}

/// The planners of a plugin. Each must be the planner that its id selects.
fn planners_of(file: &Path, plugins: &PluginDirs, found: &[PlannerInfo]) -> anyhow::Result<Vec<PlannerInfo>> {
    let refused = |why: String| bad_input(format!("{}: {why}", file.display()));
    let SurveyedPlugin { sha256, planners, refused: reason, .. } =
        check_plugin(file, &WorkerCommand::default(), plugins.requires_sandbox)
            .map_err(anyhow::Error::msg)?;
    if let Some(reason) = reason {
        return Err(refused(reason));
    }
    let is_hidden =
        |info: &&PlannerInfo| !found.iter().any(|found| found.id == info.id && found.sha256 == sha256);
    if let Some(hidden) = planners.iter().find(is_hidden) {
        return Err(refused(format!(
            "cannot be run: its planner `{}` was not found in this folder; the file must be named \
             libplanner_*.so (macOS: libplanner_*.dylib, Windows: planner_*.dll), and no plugin found earlier \
             may have a planner with this id",
            hidden.id
        )));
    }
    Ok(planners)
}
