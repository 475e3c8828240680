//! Lists all plugins found: their planners, or the reason why a plugin is refused.

mod cache;

pub(crate) use cache::Cache;

use crate::discovery::{PluginDirs, PluginFile, too_large_for_machine};
use crate::supervisor::{Failure, Worker, WorkerCommand, overweight, wait_for_one};
use crate::wire::answer::{Described, Sealed};
use crate::wire::kind;
use crate::wire::request::Load;
use crate::worker::check_descriptors;
use mission::{PlannerInfo, RefusedPlugin};
use planner_api::Caps;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Maximum time for a library to load and describe itself.
pub(crate) const LOAD_WITHIN: Duration = Duration::from_secs(2);
/// The default memory limit of a planner, bytes.
pub(crate) const MEMORY_LIMIT: u64 = 256 << 20;

/// Every plugin file, in the order in which the files are searched.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Survey {
    /// The plugins.
    pub plugins: Vec<SurveyedPlugin>,
}

/// One plugin file.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SurveyedPlugin {
    /// The path of the file.
    pub path: PathBuf,
    /// The planner ABI for which the plugin was built, as `major.minor`; absent if the file has no stamp.
    pub abi: Option<String>,
    /// SHA-256 of the file, hexadecimal; empty if the file cannot be read.
    pub sha256: String,
    /// The planners that can be chosen from this plugin.
    pub planners: Vec<PlannerInfo>,
    /// Ids of planners that an earlier plugin also contains; they cannot be chosen from this plugin.
    pub shadowed: Vec<String>,
    /// The reason why the plugin is refused; `None` if it is accepted.
    pub refused: Option<String>,
}

impl PluginDirs {
    /// Returns every file that has the name of a plugin, folder by folder and sorted by name within a folder. A file
    /// with the same content as an earlier file is the same plugin and is left out.
    pub fn plugins(&self) -> Vec<PluginFile> {
        let mut found: Vec<PluginFile> = Vec::new();
        let cache = Cache::new(self.cache.as_deref());
        for path in self.candidates() {
            let plugin = cache.seen(&path).unwrap_or_else(|| {
                let plugin = PluginFile::read(path);
                cache.note(&plugin);
                plugin
            });
            if plugin.sha256.is_empty() || found.iter().all(|known| known.sha256 != plugin.sha256) {
                found.push(plugin);
            }
        }
        found
    }
}

impl Survey {
    /// Iterates over the planners that can be chosen.
    pub fn planners(&self) -> impl Iterator<Item = &PlannerInfo> {
        self.plugins.iter().flat_map(|plugin| &plugin.planners)
    }

    /// Iterates over the plugins that are refused.
    pub fn refused(&self) -> impl Iterator<Item = RefusedPlugin> {
        self.plugins.iter().filter_map(|plugin| {
            let name = plugin.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            Some(RefusedPlugin { plugin: name, reason: plugin.refused.clone()? })
        })
    }
}

/// Surveys every plugin. A plugin that is not cached is loaded and described in a temporary worker.
pub fn survey(dirs: &PluginDirs, worker: &WorkerCommand) -> Survey {
    Surveyor::new(dirs, worker).survey()
}

/// Surveys plugins, each at most once, because a plugin that fails to load takes time.
pub struct Surveyor<'a> {
    probing: Probing<'a>,
    plugins: Vec<PluginFile>,
}

impl<'a> Surveyor<'a> {
    /// Creates a surveyor; nothing is loaded yet.
    pub fn new(dirs: &PluginDirs, worker: &'a WorkerCommand) -> Self {
        Self { probing: Probing::of(dirs, worker), plugins: dirs.plugins() }
    }

    /// Returns the planners with these ids, each from the first plugin that contains it. Only plugins that may contain
    /// one of these planners are loaded.
    pub fn find(&self, ids: &[&str]) -> Vec<PlannerInfo> {
        let find = |id: &&str| {
            let may_have = self.plugins.iter().filter(|plugin| plugin.may_have(id));
            let found = may_have.filter_map(|plugin| self.probing.planners_of(plugin).ok());
            found.flatten().find(|info| info.id == **id)
        };
        ids.iter().filter_map(find).collect()
    }

    /// If a worker could not be run for one of the plugins, returns why this machine prevents planners from running.
    pub fn no_worker(&self) -> Option<String> {
        self.probing.no_worker()
    }

    /// Returns those of the given ids that more than one plugin contains, each with the plugin that is used and the
    /// first plugin that is not used.
    pub fn shadowed(&self, ids: &[&str]) -> Vec<(String, PathBuf, PathBuf)> {
        let holders = |id: &&str| {
            let has_it = |plugin: &&PluginFile| {
                plugin.may_have(id)
                    && self
                        .probing
                        .planners_of(plugin)
                        .is_ok_and(|infos| infos.iter().any(|info| info.id == **id))
            };
            let mut holders = self.plugins.iter().filter(has_it).map(|plugin| plugin.path.clone());
            Some(((*id).to_owned(), holders.next()?, holders.next()?))
        };
        ids.iter().filter_map(holders).collect()
    }

    /// Surveys every plugin.
    pub fn survey(&self) -> Survey {
        let mut known: Vec<String> = Vec::new();
        let plugins = self.plugins.iter().map(|plugin| look_at(plugin, &self.probing, &mut known)).collect();
        Survey { plugins }
    }
}

/// Checks one file, whatever its folder and name. The file is loaded even if it is cached.
///
/// # Errors
/// The reason why this machine prevents planners from running, which is not the plugin's fault.
pub fn check_plugin(
    file: &Path,
    worker: &WorkerCommand,
    requires_sandbox: bool,
) -> Result<SurveyedPlugin, String> {
    check_descriptors()?;
    if let Some(why) = too_large_for_machine(file) {
        return Err(why);
    }
    let probing = Probing { worker, requires_sandbox, cache: Cache::new(None), refused: RefCell::default() };
    let surveyed = look_at(&PluginFile::read(file.to_path_buf()), &probing, &mut Vec::new());
    match probing.no_worker() {
        Some(why) => Err(format!("a planner plugin {why}")),
        None => Ok(surveyed),
    }
}

/// Loads and describes plugins.
struct Probing<'a> {
    worker: &'a WorkerCommand,
    requires_sandbox: bool,
    cache: Cache,
    /// Plugins that could not be loaded, and the reasons.
    refused: RefCell<BTreeMap<PathBuf, Failure>>,
}

impl<'a> Probing<'a> {
    fn of(dirs: &PluginDirs, worker: &'a WorkerCommand) -> Self {
        let cache = Cache::new(dirs.cache.as_deref());
        Self { worker, requires_sandbox: dirs.requires_sandbox, cache, refused: RefCell::default() }
    }

    fn no_worker(&self) -> Option<String> {
        self.refused.borrow().values().find_map(|failure| match failure {
            Failure::Console(why) => Some(why.clone()),
            _ => None,
        })
    }

    fn planners_of(&self, plugin: &PluginFile) -> Result<Vec<PlannerInfo>, Failure> {
        if let Some(planners) = self.cache.get(plugin) {
            return Ok(planners);
        }
        if let Some(failure) = self.refused.borrow().get(&plugin.path) {
            return Err(failure.clone());
        }
        let probed = probe(plugin, self);
        match &probed {
            Ok(planners) => self.cache.put(plugin, planners),
            Err(failure) => drop(self.refused.borrow_mut().insert(plugin.path.clone(), failure.clone())),
        }
        probed
    }
}

fn look_at(plugin: &PluginFile, probing: &Probing<'_>, known: &mut Vec<String>) -> SurveyedPlugin {
    let mut surveyed = SurveyedPlugin {
        path: plugin.path.clone(),
        abi: plugin.abi.as_ref().ok().map(ToString::to_string),
        sha256: plugin.sha256.clone(),
        planners: Vec::new(),
        shadowed: Vec::new(),
        refused: plugin.abi.as_ref().err().cloned(),
    };
    if surveyed.refused.is_none() {
        match probing.planners_of(plugin) {
            Ok(planners) => {
                let is_new = |info: &PlannerInfo| !known.contains(&info.id);
                let (new, taken): (Vec<_>, Vec<_>) = planners.into_iter().partition(is_new);
                known.extend(new.iter().map(|info| info.id.clone()));
                surveyed.planners = new;
                surveyed.shadowed = taken.into_iter().map(|info| info.id).collect();
            }
            Err(failure) => surveyed.refused = Some(refusal_text(&failure)),
        }
    }
    surveyed
}

fn probe(plugin: &PluginFile, probing: &Probing<'_>) -> Result<Vec<PlannerInfo>, Failure> {
    let mut worker = Worker::spawn(probing.worker, MEMORY_LIMIT)?;
    let load = Load::of(&plugin.path, "", MEMORY_LIMIT, probing.requires_sandbox);
    worker.ask(kind::LOAD, LOAD_WITHIN, |w| load.write(w))?;
    finished(&mut worker)?;
    let (sealed, planners) = worker.take_planners()?;
    Ok(planners.iter().map(|planner| info(planner, &sealed, &plugin.name())).collect())
}

/// Waits until a worker has answered.
fn finished(worker: &mut Worker) -> Result<(), Failure> {
    loop {
        let ready = wait_for_one(worker, None);
        if let Some(outcome) = worker.advance(ready, Instant::now(), &mut |_| {}) {
            return outcome;
        }
    }
}

/// Describes a planner in the form used by the mission.
pub(crate) fn info(planner: &Described, sealed: &Sealed, plugin: &str) -> PlannerInfo {
    PlannerInfo {
        id: planner.id.clone(),
        name: planner.name.clone(),
        version: planner.version.clone(),
        about: planner.about.clone(),
        plugin: plugin.to_owned(),
        sha256: sealed.sha256.clone(),
        abi: sealed.abi.to_string(),
        covers: Caps(planner.caps).has(Caps::COVERAGE),
        snapshots: Caps(planner.caps).has(Caps::SNAPSHOT),
        sandbox: Some(sealed.sandbox.clone()),
        parameters: planner.parameters.clone(),
    }
}

/// Explains why a library that could not be loaded is refused.
pub(crate) fn refusal_text(failure: &Failure) -> String {
    match failure {
        Failure::Refused(why) | Failure::Console(why) => why.clone(),
        Failure::Died { how, last_output } if last_output.is_empty() => format!("{how} while being loaded"),
        Failure::Died { how, last_output } => {
            format!("{how} while being loaded; last output: {last_output}")
        }
        Failure::Forbidden { call, .. } => {
            format!("tried a forbidden system call ({call}) while being loaded; its process was killed")
        }
        Failure::Overweight(limit) => {
            format!("{} while being loaded; its process was killed", overweight(*limit))
        }
        Failure::Hung | Failure::Late | Failure::Starved => {
            "did not load in time; its process was stopped".to_owned()
        }
        Failure::Planner(_) | Failure::Protocol | Failure::Gone => {
            "sent an invalid reply while being loaded".to_owned()
        }
    }
}
