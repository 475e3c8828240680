//! What plugins were found to hold, kept from one start of tankops to the next, so that not every one is loaded every time.
//!
//! An entry is believed only if it is whole, and of this very program and this system: another build may read a plugin
//! differently, another kernel may close a process off less. It says what a probe said that was closed off wholly; whoever
//! flies a planner loads and checks its file again.

use crate::discovery::{PluginFile, sha256_hex};
use crate::stamp::CONSOLE_ABI;
use crate::wire;
use mission::{PlannerInfo, Sandbox};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

/// With more entries than this the folder is emptied: an author's builds are each a new file.
const MOST_ENTRIES: usize = 256;

/// A folder with what plugins hold, one file for each.
pub(crate) struct Cache {
    folder: Option<PathBuf>,
    circumstances: String,
}

/// What is kept of a plugin.
#[derive(Serialize, Deserialize)]
struct Entry {
    /// Program and system that found it.
    circumstances: String,
    /// The plugin's own hash.
    sha256: String,
    planners: Vec<PlannerInfo>,
}

impl Cache {
    /// A cache in this folder; without a folder it holds nothing.
    pub(crate) fn new(folder: Option<&Path>) -> Self {
        Self { folder: folder.map(Path::to_owned), circumstances: circumstances() }
    }

    /// The planners of a plugin, if they are known.
    pub(crate) fn get(&self, plugin: &PluginFile) -> Option<Vec<PlannerInfo>> {
        let text = fs::read_to_string(self.file_of(plugin)?).ok()?;
        let (hash, text) = text.split_once('\n')?;
        let is_whole = sha256_hex(text.as_bytes()) == hash;
        let entry: Entry = is_whole.then(|| serde_json::from_str(text).ok())??;
        let is_of_it = entry.sha256 == plugin.sha256 && entry.circumstances == self.circumstances;
        // The same content may be there under another name.
        let named = |info| PlannerInfo { plugin: plugin.name(), ..info };
        is_of_it.then(|| entry.planners.into_iter().map(named).collect())
    }

    /// Keeps the planners of a plugin, as a probe described them. A cache that cannot be written is none.
    pub(crate) fn put(&self, plugin: &PluginFile, planners: &[PlannerInfo]) {
        let is_closed_off = planners.iter().all(|info| info.sandbox == Some(Sandbox::Full));
        let (Some(file), true) = (self.file_of(plugin), is_closed_off) else { return };
        let (circumstances, sha256) = (self.circumstances.clone(), plugin.sha256.clone());
        let entry = Entry { circumstances, sha256, planners: planners.to_vec() };
        if let Ok(text) = serde_json::to_string(&entry) {
            // What others read meanwhile is the old entry or the new one.
            let new = file.with_extension(format!("new-{}", std::process::id()));
            let _ = make_room(&file)
                .and_then(|()| fs::write(&new, format!("{}\n{text}", sha256_hex(text.as_bytes()))))
                .and_then(|()| fs::rename(&new, &file));
        }
    }

    fn file_of(&self, plugin: &PluginFile) -> Option<PathBuf> {
        let name = format!("{}.json", plugin.sha256);
        self.folder.as_ref().filter(|_| !plugin.sha256.is_empty()).map(|folder| folder.join(name))
    }
}

fn make_room(file: &Path) -> std::io::Result<()> {
    let Some(folder) = file.parent() else { return Ok(()) };
    if fs::read_dir(folder).is_ok_and(|entries| entries.count() > MOST_ENTRIES) {
        fs::remove_dir_all(folder)?;
    }
    fs::create_dir_all(folder)
}

/// This build of tankops and the kernel that it runs on.
fn circumstances() -> String {
    let program = fs::metadata("/proc/self/exe").or_else(|_| fs::metadata(std::env::current_exe()?)).ok();
    let changed =
        program.as_ref().and_then(|program| program.modified().ok()?.duration_since(UNIX_EPOCH).ok());
    // Elsewhere nothing closes a process off, and nothing is kept.
    let kernel = |what| fs::read_to_string(format!("/proc/sys/kernel/{what}")).unwrap_or_default();
    format!(
        "tankops {} ({} bytes, changed at {} ns), wire {}, ABI {CONSOLE_ABI}, kernel {} {}",
        env!("CARGO_PKG_VERSION"),
        program.map_or(0, |program| program.len()),
        changed.unwrap_or_default().as_nanos(),
        wire::VERSION,
        kernel("osrelease").trim(),
        kernel("version").trim(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::info;

    fn plugin(content: &str) -> PluginFile {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("libplanner_it.so");
        fs::write(&file, content).expect("written");
        PluginFile::read(file)
    }

    fn planners() -> Vec<PlannerInfo> {
        vec![PlannerInfo { plugin: "libplanner_it.so".into(), sandbox: Some(Sandbox::Full), ..info() }]
    }

    #[test]
    fn what_was_kept_is_found_again_for_the_same_content_only() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("a/b");
        let cache = Cache::new(Some(&place));
        cache.put(&plugin("1"), &planners());
        assert_eq!(cache.get(&plugin("1")), Some(planners()));
        assert_eq!(cache.get(&plugin("2")), None);
        assert_eq!(Cache::new(None).get(&plugin("1")), None);
    }

    #[test]
    fn an_entry_of_another_build_or_system_is_not_believed_and_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let other = Cache { circumstances: "tankops 0.0".into(), ..Cache::new(Some(folder.path())) };
        other.put(&plugin("1"), &planners());
        let cache = Cache::new(Some(folder.path()));
        assert_eq!(cache.get(&plugin("1")), None);
        cache.put(&plugin("1"), &planners());
        assert_eq!(cache.get(&plugin("1")), Some(planners()));
    }

    #[test]
    fn an_entry_that_was_changed_or_damaged_is_not_believed() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = Cache::new(Some(folder.path()));
        cache.put(&plugin("1"), &planners());
        let file = cache.file_of(&plugin("1")).expect("a folder was given");
        let good = fs::read(&file).expect("kept");
        for at in 0..good.len() {
            let mut bad = good.clone();
            bad[at] ^= 1;
            fs::write(&file, &bad).expect("written");
            assert_eq!(cache.get(&plugin("1")), None, "byte {at}");
            fs::write(&file, &good[..at]).expect("written");
            assert_eq!(cache.get(&plugin("1")), None, "cut at {at}");
        }
    }

    #[test]
    fn what_a_probe_says_that_was_not_closed_off_wholly_is_not_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = Cache::new(Some(folder.path()));
        for sandbox in [None, Some(Sandbox::Partial("seccomp".into()))] {
            let planners: Vec<_> =
                planners().into_iter().map(|info| PlannerInfo { sandbox: sandbox.clone(), ..info }).collect();
            cache.put(&plugin("1"), &planners);
            assert_eq!(cache.get(&plugin("1")), None);
        }
    }

    #[test]
    fn a_folder_with_too_many_entries_is_emptied() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = Cache::new(Some(folder.path()));
        for n in 0..=MOST_ENTRIES {
            fs::write(folder.path().join(format!("{n}.json")), "").expect("written");
        }
        cache.put(&plugin("1"), &planners());
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
    }
}
