//! From a planner's id to a worker that has loaded it.

use super::{Fault, HostConfig, fault, fault::Phase};
use crate::discovery::{PluginDirs, PluginFile};
use crate::parameters::nearest;
use crate::supervisor::{Failure, Worker};
use crate::survey::{info, load, survey};
use crate::wire::answer::{Described, Loaded};
use mission::planner::{Cause, During, PlannerInfo};

/// A worker that has loaded a planner.
pub(super) struct Found {
    pub(super) worker: Worker,
    pub(super) info: PlannerInfo,
    pub(super) caps: u32,
    pub(super) state_version: u32,
}

/// The plugin files, read when they are first needed and again when a planner is missing.
pub(super) struct Catalog {
    dirs: PluginDirs,
    plugins: Vec<PluginFile>,
}

impl Catalog {
    pub(super) fn new(dirs: PluginDirs) -> Self {
        Self { dirs, plugins: Vec::new() }
    }

    /// Loads the first plugin that has this planner; a fault comes with the hash of the plugin that is to blame.
    pub(super) fn find(&mut self, id: &str, config: &HostConfig) -> Result<Found, (Fault, String)> {
        if let Some(found) = load_first(&self.plugins, id, config)? {
            return Ok(found);
        }
        self.plugins = self.dirs.plugins();
        if let Some(found) = load_first(&self.plugins, id, config)? {
            return Ok(found);
        }
        let message = self.not_found(id, config);
        Err((fault::new(id, During::Load, Cause::Refused, message), String::new()))
    }

    fn not_found(&self, id: &str, config: &HostConfig) -> String {
        let named_so = |plugin: &&PluginFile| plugin.name().contains(&id.replace('-', "_"));
        if let Some((plugin, Err(why))) =
            self.plugins.iter().find(named_so).map(|plugin| (plugin, &plugin.abi))
        {
            return format!("planner {id} is not there: plugin {} is refused: {why}", plugin.name());
        }
        let survey = survey(&self.dirs, &config.worker_command);
        let ids: Vec<&str> = survey.planners().map(|info| info.id.as_str()).collect();
        match nearest(id, ids.iter().copied()) {
            Some(known) => format!("no plugin has the planner {id}; did you mean `{known}`?"),
            None if ids.is_empty() => {
                format!("no plugin has the planner {id}; there are no plugins in the folders searched")
            }
            None => format!("no plugin has the planner {id}; there are {}", ids.join(", ")),
        }
    }
}

/// Tries plugins in order. One that cannot be loaded does not hide the ones behind it, but is told if there is none.
fn load_first(
    plugins: &[PluginFile],
    id: &str,
    config: &HostConfig,
) -> Result<Option<Found>, (Fault, String)> {
    let mut first_failure = None;
    for plugin in plugins.iter().filter(|plugin| plugin.may_have(id)) {
        match load_one(plugin, id, config) {
            Ok(Some(found)) => return Ok(Some(found)),
            Ok(None) => {}
            Err(failure) => {
                let fault = of_plugin(failure, id, &plugin.name());
                first_failure.get_or_insert((fault, plugin.sha256.clone()));
            }
        }
    }
    first_failure.map_or(Ok(None), Err)
}

fn load_one(plugin: &PluginFile, id: &str, config: &HostConfig) -> Result<Option<Found>, Failure> {
    let mut worker = Worker::spawn(&config.worker_command)?;
    let loaded = load(&mut worker, &plugin.path, id, config.load_deadline, config.memory_limit_bytes)?;
    Ok(loaded.planners.first().map(|planner| found(worker, planner, &loaded, plugin)))
}

fn found(worker: Worker, planner: &Described, loaded: &Loaded, plugin: &PluginFile) -> Found {
    let info = info(planner, loaded, &plugin.name());
    Found { worker, info, caps: planner.caps, state_version: planner.state_version }
}

/// While a library loads, no planner of it is to blame yet.
fn of_plugin(failure: Failure, id: &str, plugin: &str) -> Fault {
    let fault = fault::of(failure, id, Phase::Load);
    let message = fault.message.replacen(&format!("planner {id} "), &format!("plugin {plugin} "), 1);
    Fault { message, ..fault }
}
