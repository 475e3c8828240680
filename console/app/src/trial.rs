//! `tankops check PLUGIN --fly N`: what a planner must do, and how it flies beside the others.

use crate::output::write_file;
use command::json::pretty_json;
use conformance::{Lost, Others, Trial};
use flight::{
    failure::{COMPLETE, ENDED_OTHERWISE, bad_input},
    planners,
};
use mission::PlannerInfo;
use planner_host::{PluginDirs, SurveyedPlugin, WorkerCommand, check_plugin};
use report::print::{say, warn_line};
use std::{
    fs, io,
    path::{Path, PathBuf},
    process::ExitCode,
};

/// Tries every planner of some plugins in `n` random tanks from a seed on; `keep` is a folder for the tanks that were lost.
pub(crate) fn fly(
    files: &[PathBuf],
    plugins: &PluginDirs,
    tanks: (u64, u64),
    json: bool,
    keep: Option<&Path>,
) -> anyhow::Result<ExitCode> {
    if let Some(file) = files.iter().find(|file| file.extension().is_some_and(|end| end == "toml")) {
        return Err(bad_input(format!(
            "{}: --fly tries plugins; to fly a scenario, use `tankops run {0}`",
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
    say(&if json { pretty_json("what came of the flights", &trials)? } else { texts.join("\n") })?;
    if let Some(folder) = keep {
        let lost: Vec<Lost> = trials.iter().flat_map(Trial::lost).collect();
        keep_lost(folder, &lost)?;
    }
    let is_passed = trials.iter().all(Trial::is_passed);
    Ok(ExitCode::from(if is_passed { COMPLETE } else { ENDED_OTHERWISE }))
}

/// Writes the tanks that were lost as scenarios, and says how one is flown.
fn keep_lost(folder: &Path, lost: &[Lost]) -> anyhow::Result<()> {
    let failed = |error: io::Error| bad_input(format!("--keep {}: {error}", folder.display()));
    fs::create_dir_all(folder).map_err(failed)?;
    for Lost { name, scenario } in lost {
        let file = folder.join(format!("{name}.toml"));
        // The same tank is the same text; one that was changed is somebody's work.
        if fs::read_to_string(&file).is_ok_and(|there| there != *scenario) {
            return Err(bad_input(format!(
                "--keep {}: already exists and was changed; choose another folder",
                file.display()
            )));
        }
        write_file("--keep", &file, scenario)?;
        warn_line(&format!("kept {}", file.display()));
    }
    if lost.is_empty() {
        warn_line("no tank was lost: nothing is kept");
    }
    Ok(())
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
        check_plugin(file, &WorkerCommand::default(), plugins.requires_sandbox)
            .map_err(anyhow::Error::msg)?;
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
