//! From a planner's id to the plugin files that may have it.

use crate::discovery::{PluginDirs, PluginFile};
use crate::parameters::nearest;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// A plugin file that may have a planner.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Candidate {
    pub(super) path: PathBuf,
    /// Name of the file without its folder.
    pub(super) name: String,
    pub(super) sha256: String,
}

/// The plugin files, read when they are first needed and again when a planner is missing.
pub(super) struct Catalog {
    dirs: PluginDirs,
    plugins: Option<Vec<PluginFile>>,
    /// Ids of planners that were loaded from them.
    known: BTreeSet<String>,
}

impl Catalog {
    pub(super) fn new(dirs: PluginDirs) -> Self {
        Self { dirs, plugins: None, known: BTreeSet::new() }
    }

    /// Reads the plugin files unless they were read before; whether they were read now.
    pub(super) fn read_once(&mut self) -> bool {
        let is_first = self.plugins.is_none();
        if is_first {
            self.read();
        }
        is_first
    }

    /// Reads the plugin files.
    pub(super) fn read(&mut self) {
        self.plugins = Some(self.dirs.plugins());
    }

    fn plugins(&self) -> &[PluginFile] {
        self.plugins.as_deref().unwrap_or_default()
    }

    /// The files that may have this planner, in the order in which they are to be tried.
    pub(super) fn candidates(&self, id: &str) -> Vec<Candidate> {
        let may_have = self.plugins().iter().filter(|plugin| plugin.may_have(id));
        may_have
            .map(|plugin| Candidate {
                path: plugin.path.clone(),
                name: plugin.name(),
                sha256: plugin.sha256.clone(),
            })
            .collect()
    }

    /// A planner of this id was loaded.
    pub(super) fn learn(&mut self, id: &str) {
        if !self.known.contains(id) {
            self.known.insert(id.to_owned());
        }
    }

    /// Why there is no planner of this id: by what is known without loading anything.
    pub(super) fn not_found(&self, id: &str) -> String {
        let named_so = |plugin: &&PluginFile| plugin.name().contains(&id.replace('-', "_"));
        if let Some((plugin, Err(why))) =
            self.plugins().iter().find(named_so).map(|plugin| (plugin, &plugin.abi))
        {
            return format!("planner {id} is not there: plugin {} is refused: {why}", plugin.name());
        }
        let plugins: BTreeSet<String> = self.plugins().iter().map(named_after).collect();
        match nearest(id, self.known.iter().chain(&plugins).map(String::as_str)) {
            Some(known) => format!("no plugin has the planner {id}; did you mean `{known}`?"),
            None if plugins.is_empty() => {
                format!("no plugin has the planner {id}; there are no plugins in the folders searched")
            }
            None => {
                let plugins: Vec<String> = plugins.into_iter().collect();
                format!("no plugin has the planner {id}; the plugins searched are {}", plugins.join(", "))
            }
        }
    }
}

/// What a planner would be called after which a plugin file is named.
fn named_after(plugin: &PluginFile) -> String {
    let stem = plugin.path.file_stem().unwrap_or_default().to_string_lossy();
    let name = stem.split_once("planner_").map_or(&*stem, |(_, name)| name);
    name.replace('_', "-")
}
