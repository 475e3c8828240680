//! The plugin files with their planners, and the changes found by a rescan.

use super::{Console, Run};
use mission::PlannerInfo;
use std::collections::BTreeSet;

/// The state of a plugin file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PluginState {
    /// The plugin's planners can be chosen.
    Ready,
    /// One of the plugin's planners is driving.
    Active,
    /// One of the plugin's planners is driving, but its build differs from the build on disk.
    Changed,
    /// The plugin cannot be used.
    Refused,
}

impl PluginState {
    /// The word for the state.
    pub fn word(self) -> &'static str {
        match self {
            Self::Ready => "ok",
            Self::Active => "ACTIVE",
            Self::Changed => "CHANGED",
            Self::Refused => "REFUSED",
        }
    }
}

/// A plugin file.
#[derive(Debug, Clone, PartialEq)]
pub struct Plugin<'a> {
    /// The file name, without the folder.
    pub file: &'a str,
    /// The state of the file.
    pub state: PluginState,
    /// The plugin's planners; empty if it is refused.
    pub planners: Vec<&'a PlannerInfo>,
    /// Why the plugin is refused, as a sentence; empty if it is not.
    pub reason: &'a str,
}

/// The plugin files, refused ones last.
pub fn plugins<'a>(console: &'a Console, run: &Run) -> Vec<Plugin<'a>> {
    let files: BTreeSet<&str> = console.planners.iter().map(|info| info.plugin.as_str()).collect();
    let found = files.into_iter().map(|file| {
        let planners: Vec<&PlannerInfo> =
            console.planners.iter().filter(|info| info.plugin == file).collect();
        Plugin { file, state: state(&planners, run), planners, reason: "" }
    });
    let refused = console.refused.iter().map(|refused| Plugin {
        file: &refused.plugin,
        state: PluginState::Refused,
        planners: Vec::new(),
        reason: &refused.reason,
    });
    found.chain(refused).collect()
}

fn state(planners: &[&PlannerInfo], run: &Run) -> PluginState {
    let active = run.planning.info.as_ref();
    match active
        .and_then(|active| planners.iter().find(|info| info.id == active.id).map(|info| (active, info)))
    {
        Some((active, info)) if active.sha256 == info.sha256 => PluginState::Active,
        Some(_) => PluginState::Changed,
        None => PluginState::Ready,
    }
}

/// The changes found by a rescan of the plugins, as sentences.
pub fn differences(before: &[PlannerInfo], now: &[PlannerInfo]) -> Vec<String> {
    let find = |list: &[PlannerInfo], id: &str| list.iter().find(|info| info.id == id).cloned();
    let gone =
        before.iter().filter(|info| find(now, &info.id).is_none()).map(|info| format!("{}: gone", info.id));
    let others = now.iter().filter_map(|info| match find(before, &info.id) {
        None => Some(format!("{}: new, from {}", info.id, info.plugin)),
        Some(old) if old.sha256 != info.sha256 => Some(rebuilt(&old, info)),
        Some(_) => None,
    });
    gone.chain(others).collect()
}

fn rebuilt(old: &PlannerInfo, new: &PlannerInfo) -> String {
    let keys =
        |info: &PlannerInfo| info.parameters.iter().map(|info| info.key.clone()).collect::<BTreeSet<_>>();
    let (before, now) = (keys(old), keys(new));
    let added = now.difference(&before).map(|key| format!("+{key}"));
    let parameters: Vec<String> = added.chain(before.difference(&now).map(|key| format!("-{key}"))).collect();
    let version = if old.version == new.version {
        String::new()
    } else {
        format!(", {} → {}", old.version, new.version)
    };
    let parameters =
        if parameters.is_empty() { String::new() } else { format!(", parameters {}", parameters.join(" ")) };
    format!("{}: rebuilt{version}{parameters}", new.id)
}
