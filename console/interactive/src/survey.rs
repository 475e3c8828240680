//! What was found when the plugins were looked at, for the screen.

use mission::PlannerInfo;
use planner_host::{PluginDirs, WorkerCommand, survey};
use tui::Refused;

/// Planners that can be chosen, and plugins that are refused.
pub(super) fn surveyed(plugins: &PluginDirs) -> (Vec<PlannerInfo>, Vec<Refused>) {
    let survey = survey(plugins, &WorkerCommand::default());
    let refused = survey.plugins.iter().filter_map(|plugin| {
        let name =
            plugin.path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        Some(Refused { plugin: name, reason: plugin.refused.clone()? })
    });
    (survey.planners().cloned().collect(), refused.collect())
}
