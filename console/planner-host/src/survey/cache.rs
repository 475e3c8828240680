//! Caches which planners each plugin contains, so that tankops need not load every plugin each time it starts.
//!
//! An entry is used only if it is complete and was made by the same program on the same system: a different build may
//! read a plugin differently, and a different kernel may provide a weaker sandbox. An entry contains what a fully
//! sandboxed probe reported. Before a mission uses a planner, its file is loaded and checked again.

use crate::discovery::{PluginFile, Words, sha256_hex};
use crate::stamp::{Abi, CONSOLE_ABI};
use crate::wire;
use mission::{PlannerInfo, Sandbox};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// The maximum number of entries, beyond which the folder is emptied. Every build that an author makes adds an entry.
const MOST_ENTRIES: usize = 256;

/// A file that changed less than this time ago could change again and keep its modification time, because file times
/// are coarse.
const SETTLED: Duration = Duration::from_secs(1);

/// A folder with one file for each plugin content, which lists the planners, and one file for each path, which
/// identifies the content.
pub(crate) struct Cache {
    folder: Option<PathBuf>,
    circumstances: String,
}

/// A cached value, with the program and the system that produced it.
#[derive(Serialize, Deserialize)]
struct Entry<T> {
    circumstances: String,
    /// The hash of the plugin's content, or of its path.
    of: String,
    kept: T,
}

/// A plugin file as it was last read.
#[derive(Serialize, Deserialize)]
struct Place {
    identity: Identity,
    sha256: String,
    abi: Abi,
    ids: Option<Vec<String>>,
}

/// Identifies the content of a file: its device, inode, length, and the times of its last modification and last status
/// change. At least one of them changes whenever the file is written to.
type Identity = (u64, u64, u64, (i64, i64), (i64, i64));

impl Cache {
    /// Opens a cache in this folder; without a folder, the cache stays empty.
    pub(crate) fn new(folder: Option<&Path>) -> Self {
        let circumstances = folder.map(|_| circumstances()).unwrap_or_default();
        Self { folder: folder.map(Path::to_owned), circumstances }
    }

    /// Returns the planners of a plugin, if they are cached.
    pub(crate) fn get(&self, plugin: &PluginFile) -> Option<Vec<PlannerInfo>> {
        let planners: Vec<PlannerInfo> = self.read(&plugin.sha256)?;
        // The same content may exist under a different name.
        let named = |info| PlannerInfo { plugin: plugin.name(), ..info };
        Some(planners.into_iter().map(named).collect())
    }

    /// Stores the planners of a plugin as a probe described them, unless the probe found a different file.
    pub(crate) fn put(&self, plugin: &PluginFile, planners: &[PlannerInfo]) {
        let is_sure =
            |info: &PlannerInfo| info.sandbox == Some(Sandbox::Full) && info.sha256 == plugin.sha256;
        if planners.iter().all(is_sure) {
            self.write(&plugin.sha256, planners);
        }
    }

    /// Returns a plugin file if it was read earlier and has not been modified since.
    pub(crate) fn seen(&self, path: &Path) -> Option<PluginFile> {
        let Place { identity, sha256, abi, ids } = self.read(&hash_of(path)?)?;
        let (now, _) = identity_of(path)?;
        let plugin =
            PluginFile { path: path.to_owned(), sha256, abi: Ok(abi), words: Words::Ids(Vec::new()) };
        let known = || Some(self.get(&plugin)?.into_iter().map(|info| info.id).collect());
        let ids = ids.or_else(known).filter(|_| now == identity)?;
        Some(PluginFile { words: Words::Ids(ids), ..plugin })
    }

    /// Stores what was read from a plugin file.
    pub(crate) fn note(&self, plugin: &PluginFile) {
        let settled = identity_of(&plugin.path).filter(|(_, age)| *age > SETTLED);
        if let (Ok(abi), Some((identity, _)), Some(of)) = (&plugin.abi, settled, hash_of(&plugin.path)) {
            let ids = match &plugin.words {
                Words::Ids(ids) => Some(ids.clone()),
                Words::Bytes(_) => None,
            };
            self.write(&of, &Place { identity, sha256: plugin.sha256.clone(), abi: *abi, ids });
        }
    }

    fn read<T: DeserializeOwned>(&self, of: &str) -> Option<T> {
        let text = fs::read_to_string(self.file_of(of)?).ok()?;
        let (hash, text) = text.split_once('\n')?;
        let is_whole = sha256_hex(text.as_bytes()) == hash;
        let entry: Entry<T> = is_whole.then(|| serde_json::from_str(text).ok())??;
        (entry.of == of && entry.circumstances == self.circumstances).then_some(entry.kept)
    }

    /// Writes an entry. Failures are ignored, as if there were no cache.
    fn write<T: Serialize + ?Sized>(&self, of: &str, kept: &T) {
        let Some(file) = self.file_of(of) else { return };
        let entry = Entry { circumstances: self.circumstances.clone(), of: of.to_owned(), kept };
        if let Ok(text) = serde_json::to_string(&entry) {
            // Other processes that read the entry meanwhile get either the old one or the new one.
            let new = file.with_extension(format!("new-{}", std::process::id()));
            let _ = make_room(&file)
                .and_then(|()| fs::write(&new, format!("{}\n{text}", sha256_hex(text.as_bytes()))))
                .and_then(|()| fs::rename(&new, &file));
        }
    }

    fn file_of(&self, of: &str) -> Option<PathBuf> {
        self.folder.as_ref().filter(|_| !of.is_empty()).map(|folder| folder.join(format!("{of}.json")))
    }
}

/// Returns the hash of a file's absolute path.
fn hash_of(path: &Path) -> Option<String> {
    let absolute = std::path::absolute(path).ok()?;
    Some(sha256_hex(absolute.as_os_str().as_encoded_bytes()))
}

/// Returns the identity of a file's content, and the time since the file changed.
fn identity_of(path: &Path) -> Option<(Identity, Duration)> {
    let about = fs::metadata(path).ok()?;
    let changed =
        UNIX_EPOCH + Duration::new(about.ctime().try_into().ok()?, about.ctime_nsec().try_into().ok()?);
    let times = ((about.mtime(), about.mtime_nsec()), (about.ctime(), about.ctime_nsec()));
    let age = SystemTime::now().duration_since(changed).unwrap_or_default();
    Some(((about.dev(), about.ino(), about.len(), times.0, times.1), age))
}

fn make_room(file: &Path) -> std::io::Result<()> {
    let Some(folder) = file.parent() else { return Ok(()) };
    if fs::read_dir(folder).is_ok_and(|entries| entries.count() > MOST_ENTRIES) {
        fs::remove_dir_all(folder)?;
    }
    fs::create_dir_all(folder)
}

/// Describes this build of tankops and the kernel on which it runs.
fn circumstances() -> String {
    let program = fs::metadata("/proc/self/exe").or_else(|_| fs::metadata(std::env::current_exe()?)).ok();
    let changed =
        program.as_ref().and_then(|program| program.modified().ok()?.duration_since(UNIX_EPOCH).ok());
    // Other systems have no sandbox, so nothing is cached there.
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

    /// The report of a probe on the plugin `1`.
    fn planners() -> Vec<PlannerInfo> {
        let (plugin_name, sha256) = ("libplanner_it.so".into(), plugin("1").sha256);
        vec![PlannerInfo { plugin: plugin_name, sha256, sandbox: Some(Sandbox::Full), ..info() }]
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
        let file = cache.file_of(&plugin("1").sha256).expect("a folder was given");
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
    fn what_a_probe_found_in_another_file_than_was_read_before_is_not_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = Cache::new(Some(folder.path()));
        cache.put(&plugin("2"), &planners());
        assert_eq!(cache.get(&plugin("2")), None);
    }

    #[test]
    fn a_file_is_read_again_once_it_was_touched() {
        let (folder, place) =
            (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
        let built = std::env::current_exe().expect("a path").with_file_name("libplanner_faulty.so");
        let file = place.path().join("libplanner_it.so");
        fs::copy(built, &file).expect("copied");
        let (cache, plugin) = (Cache::new(Some(folder.path())), PluginFile::read(file.clone()));
        cache.note(&plugin);
        assert_eq!(cache.seen(&file), None, "it may be written to again in the same moment");
        std::thread::sleep(SETTLED + Duration::from_millis(100));
        cache.note(&plugin);
        assert_eq!(cache.seen(&file), Some(plugin));
        let touched = fs::File::options().append(true).open(&file).expect("opened");
        touched.set_modified(SystemTime::now()).expect("touched");
        assert_eq!(cache.seen(&file), None);
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
