//! Finds the plugin files in the folders that may contain them.

mod stamps;

pub use stamps::{FileStamp, Stamps};

use crate::stamp::{self, Abi};
use crate::user_folder::user_folder;
use rustix::fs::OFlags;
use rustix::process::{Resource, getrlimit};
use sha2::{Digest, Sha256};
use std::env;
use std::ffi::OsStr;
use std::fs::File;
use std::io::Read;
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

/// The folders with plugins, and the conditions for loading them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PluginDirs {
    /// The folders; if more than one contains the same planner, the first is used.
    pub folders: Vec<PathBuf>,
    /// Whether a plugin is refused if its process cannot be fully sandboxed.
    pub requires_sandbox: bool,
    /// The folder that caches which planners each plugin contains.
    pub cache: Option<PathBuf>,
}

impl PluginDirs {
    /// Uses these folders without a cache. Plugins are loaded even if their processes cannot be fully sandboxed.
    pub fn of(folders: Vec<PathBuf>) -> Self {
        Self { folders, requires_sandbox: false, cache: None }
    }

    /// Uses the standard folders: those given by the user, `$TANKOPS_PLUGIN_PATH`, `plugins` beside the program, the
    /// program's own folder and `deps` in it (where Cargo puts libraries), `../lib/tankops/plugins` relative to the
    /// program, and `$XDG_DATA_HOME/tankops/plugins`. The contents are cached in `$XDG_CACHE_HOME/tankops/plugins`.
    pub fn standard(extra: &[PathBuf]) -> Self {
        let mut dirs = extra.to_vec();
        dirs.extend(env::var_os("TANKOPS_PLUGIN_PATH").iter().flat_map(env::split_paths));
        if let Some(beside) = env::current_exe().ok().as_deref().and_then(Path::parent) {
            dirs.extend([beside.join("plugins"), beside.to_owned(), beside.join("deps")]);
            dirs.extend(beside.parent().map(|prefix| prefix.join("lib/tankops/plugins")));
        }
        let plugins_in = |folder: PathBuf| folder.join("plugins");
        dirs.extend(user_folder("XDG_DATA_HOME", ".local/share").map(plugins_in));
        dirs.retain(|dir| !dir.as_os_str().is_empty());
        Self { cache: user_folder("XDG_CACHE_HOME", ".cache").map(plugins_in), ..Self::of(dirs) }
    }

    /// Returns the SHA-256 of the first plugin file with this name, hexadecimal; `None` if it cannot be read.
    pub fn sha256_of(&self, plugin: &str) -> Option<String> {
        let file = self.folders.iter().map(|dir| dir.join(plugin)).find(|file| file.is_file())?;
        read_bytes(&file).ok().map(|bytes| sha256_hex(&bytes))
    }

    /// Returns the paths of all files that have the name of a plugin, folder by folder.
    pub(crate) fn candidates(&self) -> Vec<PathBuf> {
        self.folders.iter().flat_map(|dir| named_like_plugins(dir)).collect()
    }
}

fn named_like_plugins(dir: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(dir) else { return Vec::new() };
    let mut paths: Vec<PathBuf> =
        entries.flatten().map(|entry| entry.path()).filter(|p| is_plugin_name(p)).collect();
    paths.sort();
    paths
}

fn is_plugin_name(path: &Path) -> bool {
    let part = |part: Option<&OsStr>| part.and_then(OsStr::to_str).unwrap_or_default().to_owned();
    let (stem, extension) = (part(path.file_stem()), part(path.extension()));
    match extension.as_str() {
        "so" | "dylib" => stem.starts_with("libplanner_"),
        "dll" => stem.starts_with("planner_"),
        _ => false,
    }
}

/// Maximum size of a plugin file, bytes.
pub(crate) const MOST_BYTES: u64 = 128 << 20;

/// A file that has the name of a plugin, with everything that can be determined without loading it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PluginFile {
    /// The path of the file.
    pub path: PathBuf,
    /// SHA-256 of the file, hexadecimal; empty when the file cannot be read.
    pub sha256: String,
    /// The ABI version in the file's stamp, or the reason why the file is refused.
    pub abi: Result<Abi, String>,
    pub(crate) words: Words,
}

/// The data that shows which planners a plugin contains.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Words {
    /// The complete list of the planners' ids.
    Ids(Vec<String>),
    /// The bytes of a file without a list of ids; the ids can be anywhere in them.
    Bytes(Vec<u8>),
}

impl PluginFile {
    /// Reads a file and checks its stamp.
    pub fn read(path: PathBuf) -> Self {
        match read_bytes(&path) {
            Ok(words) => {
                let abi = stamp::read(&words).map_err(|error| error.to_string());
                let (sha256, ids) = (sha256_hex(&words), stamp::ids(&words));
                let words = match ids {
                    _ if abi.is_err() => Words::Ids(Vec::new()),
                    Some(ids) => Words::Ids(ids),
                    None => Words::Bytes(words),
                };
                Self { path, sha256, abi, words }
            }
            Err(error) => {
                let abi = Err(error);
                Self { path, sha256: String::new(), abi, words: Words::Ids(Vec::new()) }
            }
        }
    }

    /// Returns the name of the file, without its folder.
    pub fn name(&self) -> String {
        self.path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Whether the file may contain this planner. Rust libraries list their ids. Other libraries are searched for the
    /// bytes of the id, so a planner whose id is composed at run time is not found. A refused file is taken to contain
    /// no planners.
    pub fn may_have(&self, id: &str) -> bool {
        match &self.words {
            Words::Ids(ids) => ids.iter().any(|known| known == id),
            Words::Bytes(bytes) => {
                !id.is_empty() && bytes.windows(id.len()).any(|window| window == id.as_bytes())
            }
        }
    }
}

/// Reads a file, which must be a regular file of reasonable size even if its path changes meanwhile. A device or a pipe
/// might never end.
pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, String> {
    let unreadable = |error: std::io::Error| format!("cannot be read: {error}");
    // Opening a pipe without this flag would wait for a writer.
    let at_once = OFlags::NONBLOCK.bits().cast_signed();
    let file = File::options().read(true).custom_flags(at_once).open(path).map_err(unreadable)?;
    let about = file.metadata().map_err(unreadable)?;
    if !about.is_file() {
        return Err("not a regular file".into());
    }
    let too_large = |length: u64| format!("has {length} bytes; a plugin may have at most {MOST_BYTES}");
    if about.len() > MOST_BYTES {
        return Err(too_large(about.len()));
    }
    let mut bytes = Vec::with_capacity(about.len() as usize);
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    // The file may have grown since its length was checked.
    if bytes.len() as u64 > MOST_BYTES { Err(too_large(bytes.len() as u64)) } else { Ok(bytes) }
}

/// Returns the reason why no process on this machine can make a private copy of a plugin. Returns `None` if a process
/// can make the copy, or if the file is too large to be a plugin.
pub(crate) fn too_large_for_machine(path: &Path) -> Option<String> {
    let length = path.metadata().ok().filter(std::fs::Metadata::is_file)?.len();
    let limit = getrlimit(Resource::Fsize).current.filter(|limit| *limit < length && length <= MOST_BYTES)?;
    Some(format!(
        "the system limits files to {limit} bytes, but {} has {length}; try `ulimit -f {}`",
        path.display(),
        MOST_BYTES / 1024
    ))
}

/// Returns the SHA-256 in hexadecimal.
pub(crate) fn sha256_hex(bytes: &[u8]) -> String {
    hex::encode(Sha256::digest(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plugins_are_known_by_their_names() {
        for good in ["libplanner_apf.so", "libplanner_x.dylib", "planner_apf.dll"] {
            assert!(is_plugin_name(Path::new(good)), "{good}");
        }
        for other in ["libapf.so", "libplanner_apf.rlib", "planner_apf.so", "libplanner_apf.d"] {
            assert!(!is_plugin_name(Path::new(other)), "{other}");
        }
    }

    #[test]
    fn a_library_with_a_hole_has_a_digest() {
        let folder = tempfile::tempdir().unwrap();
        let name = "libplanner_sparse.so";
        let file = File::create(folder.path().join(name)).unwrap();
        file.set_len(1 << 20).unwrap();
        let dirs = PluginDirs::of(vec![PathBuf::from("nowhere"), folder.path().to_owned()]);
        assert_eq!(dirs.sha256_of(name), Some(sha256_hex(&vec![0; 1 << 20])));
        assert_eq!(dirs.sha256_of("libplanner_none.so"), None);
    }

    #[test]
    fn the_same_content_in_two_folders_is_one_plugin() {
        let (first, second) = (tempfile::tempdir().expect("dir"), tempfile::tempdir().expect("dir"));
        for (dir, name, content) in [(&first, "b", "1"), (&second, "b", "1"), (&second, "a", "2")] {
            std::fs::write(dir.path().join(format!("libplanner_{name}.so")), content).expect("written");
        }
        let dirs = PluginDirs::of(vec![first.path().into(), second.path().into()]);
        let names: Vec<PathBuf> = dirs.plugins().into_iter().map(|plugin| plugin.path).collect();
        assert_eq!(names, [first.path().join("libplanner_b.so"), second.path().join("libplanner_a.so")]);
    }

    #[test]
    fn what_is_no_plain_file_is_not_waited_for() {
        let folder = tempfile::tempdir().expect("dir");
        let place = |name: &str| folder.path().join(name);
        rustix::fs::mkfifoat(rustix::fs::CWD, place("pipe"), rustix::fs::Mode::RWXU).expect("a pipe");
        assert_eq!(read_bytes(&place("pipe")), Err("not a regular file".into()));
        assert_eq!(read_bytes(folder.path()), Err("not a regular file".into()));
        let sparse = File::create(place("sparse")).expect("a file");
        sparse.set_len(10 << 30).expect("a length");
        let why = read_bytes(&place("sparse")).expect_err("too large");
        assert_eq!(why, "has 10737418240 bytes; a plugin may have at most 134217728");
        std::os::unix::fs::symlink(place("pipe"), place("link")).expect("a link");
        assert_eq!(read_bytes(&place("link")), Err("not a regular file".into()));
    }

    #[test]
    fn a_folder_that_is_not_there_has_no_plugins() {
        assert!(PluginDirs::of(vec!["/no/such/folder".into()]).plugins().is_empty());
    }

    #[test]
    fn folders_given_by_hand_come_first() {
        let dirs = PluginDirs::standard(&["mine".into()]);
        assert_eq!(dirs.folders[0], Path::new("mine"));
        assert!(dirs.folders.iter().any(|dir| dir.ends_with("deps")));
    }

    #[test]
    fn hashes_are_hexadecimal() {
        assert!(sha256_hex(b"").starts_with("e3b0c44298fc1c149afb"));
    }
}
