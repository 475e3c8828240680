//! Finds the plugin files that may contain the planner with a given id.

use crate::discovery::{PluginDirs, PluginFile};
use crate::survey::Cache;
use mission::spelling::nearest;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::PathBuf;

/// A plugin file that may contain a planner.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Candidate {
    pub(super) path: PathBuf,
    /// The name of the file, without its folder.
    pub(super) name: String,
    pub(super) sha256: String,
}

/// The plugin files. They are read when first needed, and again when a planner is missing.
pub(super) struct Catalog {
    dirs: PluginDirs,
    cache: Cache,
    plugins: Option<Vec<PluginFile>>,
    /// Ids of planners that were loaded, each with the first file that contains it; `None` if the files have been read
    /// again and this file is not known yet.
    known: BTreeMap<String, Option<Candidate>>,
}

/// The progress of a search for a planner.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) enum Search {
    #[default]
    NotBegun,
    /// Tried the file from which the planner was loaded before.
    Known(Candidate),
    /// Tried all files, as they had been read for an earlier planner.
    Remembered,
    /// Tried all files, as they were read for this planner; reading them again would find nothing new.
    Fresh,
}

impl Catalog {
    pub(super) fn new(dirs: PluginDirs) -> Self {
        let cache = Cache::new(dirs.cache.as_deref());
        Self { dirs, cache, plugins: None, known: BTreeMap::new() }
    }

    /// Whether a plugin is refused if its process cannot be fully sandboxed.
    pub(super) fn requires_sandbox(&self) -> bool {
        self.dirs.requires_sandbox
    }

    /// Continues the search for a planner. Returns the files to try next, in order, or `None` when all were tried. The
    /// files can be read again before the search gives up, because a plugin may have been built meanwhile.
    pub(super) fn search_on(
        &mut self,
        id: &str,
        search: &mut Search,
        may_read_again: bool,
    ) -> Option<VecDeque<Candidate>> {
        let (next, files) = match std::mem::take(search) {
            Search::NotBegun if self.plugins.is_none() => (Search::Fresh, self.read_for(id)),
            Search::NotBegun => match self.known.get(id).cloned().flatten() {
                Some(file) => (Search::Known(file.clone()), VecDeque::from([file])),
                None => (Search::Remembered, self.candidates(id)),
            },
            Search::Known(tried) => {
                // This file could be loaded earlier, so it is tried once more before a different build replaces it.
                let mut files = self.candidates(id);
                files.retain(|file| *file != tried);
                files.push_front(tried);
                (Search::Remembered, files)
            }
            Search::Remembered if may_read_again => (Search::Fresh, self.read_for(id)),
            Search::Remembered | Search::Fresh => return None,
        };
        *search = next;
        Some(files)
    }

    /// Reads the plugin files and returns those that may contain this planner.
    fn read_for(&mut self, id: &str) -> VecDeque<Candidate> {
        self.plugins = Some(self.dirs.plugins());
        // A new file may precede the file that had been the first with a planner.
        self.known.values_mut().for_each(|file| *file = None);
        self.candidates(id)
    }

    fn plugins(&self) -> &[PluginFile] {
        self.plugins.as_deref().unwrap_or_default()
    }

    /// Returns the files that may contain this planner, in the order in which to try them.
    fn candidates(&self, id: &str) -> VecDeque<Candidate> {
        let is_known_to_lack = |plugin: &PluginFile| {
            self.cache.get(plugin).is_some_and(|planners| planners.iter().all(|info| info.id != id))
        };
        let may_have =
            self.plugins().iter().filter(|plugin| plugin.may_have(id) && !is_known_to_lack(plugin));
        may_have
            .map(|plugin| Candidate {
                path: plugin.path.clone(),
                name: plugin.name(),
                sha256: plugin.sha256.clone(),
            })
            .collect()
    }

    /// Records that a planner was loaded. `file` is given only if it is the first file that contains the planner.
    pub(super) fn learn(&mut self, id: &str, file: Option<Candidate>) {
        self.known.insert(id.to_owned(), file);
    }

    /// Explains why no planner has this id, as far as this is known without loading a plugin.
    pub(super) fn not_found(&self, id: &str) -> String {
        let named_so = |plugin: &&PluginFile| plugin.name().contains(&id.replace('-', "_"));
        if let Some((plugin, Err(why))) =
            self.plugins().iter().find(named_so).map(|plugin| (plugin, &plugin.abi))
        {
            return format!("planner {id} is not available: plugin {} is refused: {why}", plugin.name());
        }
        let plugins: BTreeSet<String> = self.plugins().iter().map(named_after).collect();
        match nearest(id, self.known.keys().chain(&plugins).map(String::as_str)) {
            Some(known) => format!("no plugin has the planner {id}; did you mean `{known}`?"),
            None if plugins.is_empty() => {
                format!("no plugin has the planner {id}; the folders searched contain no plugins")
            }
            None => {
                let plugins: Vec<String> = plugins.into_iter().collect();
                format!("no plugin has the planner {id}; the plugins searched are {}", plugins.join(", "))
            }
        }
    }
}

/// Derives a planner id from the name of a plugin file.
fn named_after(plugin: &PluginFile) -> String {
    let stem = plugin.path.file_stem().unwrap_or_default().to_string_lossy();
    let name = stem.split_once("planner_").map_or(&*stem, |(_, name)| name);
    name.replace('_', "-")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::{copy, read, write};
    use tempfile::TempDir;

    /// A catalog of two files that contain the planner `faulty`.
    fn catalog() -> (TempDir, Catalog) {
        let folder = tempfile::tempdir().expect("a folder");
        let built = std::env::current_exe().expect("a path").with_file_name("libplanner_faulty.so");
        let [first, second] = ["a", "b"].map(|name| folder.path().join(format!("libplanner_{name}.so")));
        copy(&built, first).expect("copied");
        write(second, [read(built).expect("read"), vec![0]].concat()).expect("written");
        let catalog = Catalog::new(PluginDirs::of(vec![folder.path().to_owned()]));
        (folder, catalog)
    }

    /// The names of the files that each search finds, one list for each search.
    fn found(catalog: &mut Catalog, may_read_again: bool) -> Vec<Vec<String>> {
        let mut search = Search::default();
        let files = std::iter::from_fn(|| catalog.search_on("faulty", &mut search, may_read_again));
        files.map(|files| files.into_iter().map(|file| file.name).collect()).collect()
    }

    const A: &str = "libplanner_a.so";
    const B: &str = "libplanner_b.so";

    #[test]
    fn files_are_tried_in_order_and_read_again_when_none_has_the_planner() {
        let (folder, mut catalog) = catalog();
        assert_eq!(found(&mut catalog, true), [[A, B]], "read for this planner");
        copy(folder.path().join(B), folder.path().join("libplanner_0.so")).expect("copied");
        assert_eq!(found(&mut catalog, false), [[A, B]]);
        assert_eq!(
            found(&mut catalog, true),
            [[A, B], ["libplanner_0.so", A]],
            "b has the same content as 0"
        );
    }

    #[test]
    fn the_file_that_had_a_planner_is_tried_twice_before_the_others() {
        let (_folder, mut catalog) = catalog();
        let mut search = Search::default();
        let mut files = catalog.search_on("faulty", &mut search, true).expect("two files");
        catalog.learn("faulty", files.pop_back());
        assert_eq!(found(&mut catalog, false), [vec![B], vec![B, A]]);
        assert_eq!(found(&mut catalog, true), [vec![B], vec![B, A], vec![A, B]]);
        assert_eq!(found(&mut catalog, false), [[A, B]], "files that were read again may be others");
    }

    #[test]
    fn a_planner_whose_first_file_is_uncertain_is_searched_for_in_all() {
        let (_folder, mut catalog) = catalog();
        assert_eq!(found(&mut catalog, false), [[A, B]]);
        catalog.learn("faulty", None);
        assert_eq!(found(&mut catalog, false), [[A, B]]);
    }
}
