//! The plugin files and their modification times; they are cheap enough to poll.

use super::{PluginDirs, named_like_plugins};
use std::{
    fs,
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

/// The coarsest resolution of file times on common file systems. If a folder changed less than this time before it was
/// listed, a further change may leave its modification time the same.
const COARSEST: Duration = Duration::from_secs(2);

/// The modification times of all files in some folders that have the names of plugins.
///
/// A check costs one system call for each folder and for each such file. A folder is listed again only after something
/// was added to it or removed from it, because a build folder contains thousands of other files.
#[derive(Debug)]
pub struct Stamps {
    folders: Vec<Folder>,
}

/// The path, modification time and length of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileStamp {
    path: PathBuf,
    written: Option<SystemTime>,
    length: u64,
}

#[derive(Debug)]
struct Folder {
    path: PathBuf,
    /// The folder's modification time when it was listed; `None` if that listing cannot be relied on.
    listed: Option<SystemTime>,
    files: Vec<PathBuf>,
}

impl Stamps {
    /// Watches these folders; the first check lists them all.
    pub fn of(plugins: &PluginDirs) -> Self {
        let folder = |path: &PathBuf| Folder { path: path.clone(), listed: None, files: Vec::new() };
        Self { folders: plugins.folders.iter().map(folder).collect() }
    }

    /// Returns when each file was last modified, and its length, without reading any file. A new build changes the
    /// result.
    pub fn look(&mut self) -> Vec<FileStamp> {
        let now = SystemTime::now();
        self.folders.iter_mut().flat_map(|folder| folder.look(now)).collect()
    }
}

impl Folder {
    fn look(&mut self, now: SystemTime) -> Vec<FileStamp> {
        let changed = fs::metadata(&self.path).and_then(|about| about.modified()).ok();
        if changed.is_none() || changed != self.listed {
            self.files = named_like_plugins(&self.path);
            let rests = |at: &SystemTime| now.duration_since(*at).is_ok_and(|since| since > COARSEST);
            self.listed = changed.filter(rests);
        }
        self.files.iter().filter_map(|path| FileStamp::of(path)).collect()
    }
}

impl FileStamp {
    fn of(path: &Path) -> Option<Self> {
        let about = fs::metadata(path).ok()?;
        Some(Self { path: path.to_owned(), written: about.modified().ok(), length: about.len() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::File;

    fn looked(stamps: &mut Stamps) -> Vec<(String, u64)> {
        let name =
            |stamp: FileStamp| (stamp.path.file_name().unwrap().to_str().unwrap().to_owned(), stamp.length);
        stamps.look().into_iter().map(name).collect()
    }

    #[test]
    fn files_that_come_change_and_go_are_seen() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        let mut stamps = Stamps::of(&PluginDirs::of(vec![folder.path().to_owned(), file("none")]));
        assert_eq!(looked(&mut stamps), []);
        fs::write(file("libplanner_a.so"), "a").unwrap();
        fs::write(file("other.txt"), "a").unwrap();
        assert_eq!(looked(&mut stamps), [("libplanner_a.so".into(), 1)]);
        fs::write(file("libplanner_a.so"), "ab").unwrap();
        assert_eq!(looked(&mut stamps), [("libplanner_a.so".into(), 2)]);
        fs::remove_file(file("libplanner_a.so")).unwrap();
        assert_eq!(looked(&mut stamps), []);
    }

    #[test]
    fn a_folder_that_rests_is_not_listed_again_and_its_files_are_still_looked_at() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("libplanner_a.so");
        fs::write(&path, "a").unwrap();
        let long_ago = SystemTime::now() - Duration::from_mins(1);
        File::open(folder.path()).unwrap().set_modified(long_ago).unwrap();
        let mut stamps = Stamps::of(&PluginDirs::of(vec![folder.path().to_owned()]));
        let before = stamps.look();
        assert_eq!(stamps.folders[0].listed, Some(long_ago));
        // The file is overwritten in place, so the folder itself does not change.
        fs::write(&path, "ab").unwrap();
        assert_eq!(fs::metadata(folder.path()).unwrap().modified().unwrap(), long_ago);
        assert_ne!(stamps.look(), before);
        // A file that is added later is found, too.
        fs::write(folder.path().join("libplanner_b.so"), "b").unwrap();
        assert_eq!(stamps.look().len(), 2);
    }
}
