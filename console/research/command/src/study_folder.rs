//! The folder of a study or a search: the request, and the results so far. The same command with the same folder
//! resumes the work, and shares it with other processes that run at the same time.

use command::{here::Here, shared_folder::SharedFolder};
use flight::failure::bad_input;
use planner_host::PluginDirs;
use report::print::warn_line;
use reproduce::Parts;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::{
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
};

/// The file with the request, and with the identity of the program that computes it.
const FROZEN: &str = "study.json";
const PARTS: &str = "parts";
/// The file with the results, which is written once every part is complete.
const RESULT: &str = "result.json";

/// Length of the trailer of a part, bytes. A part consists of its results and this trailer: the SHA-256 of the
/// request, the part's name and its results.
const DIGEST: usize = 32;

/// A folder of results.
pub(crate) struct StudyFolder {
    folder: SharedFolder,
    /// The request.
    asked: String,
    /// Whether the wait for other processes has been reported.
    has_waited: AtomicBool,
}

impl StudyFolder {
    /// Opens the folder for a request with the installed planners and this program; creates it if it does not exist.
    pub(crate) fn open(path: &Path, asked: &Value, plugins: &PluginDirs) -> anyhow::Result<Self> {
        let folder = SharedFolder::new(path);
        folder.make(&[PARTS]).map_err(|error| bad_input(format!("--out {error:#}")))?;
        let asked = serde_json::json!({ "asked": asked, "program": Here::survey(plugins)?.program });
        let refused = |why: &str| bad_input(format!("--out {}: {why}", path.join(FROZEN).display()));
        match folder.read(Path::new(FROZEN)).map_err(|error| refused(&error.to_string()))? {
            None => folder.publish(Path::new(FROZEN), &serde_json::to_vec_pretty(&asked)?)?,
            Some(there) => match serde_json::from_slice(&there) {
                Err(error) => return Err(refused(&format!("{error}; choose a different folder"))),
                Ok(there) => difference(&there, &asked).map_or(Ok(()), |what| {
                    Err(refused(&format!("the folder contains results {what}; choose a different folder")))
                })?,
            },
        }
        Ok(Self { folder, asked: asked.to_string(), has_waited: AtomicBool::new(false) })
    }

    fn digest(&self, name: &str, answers: &[u8]) -> [u8; DIGEST] {
        let mut hash = Sha256::new();
        for part in [self.asked.as_bytes(), name.as_bytes()] {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        }
        hash.update(answers);
        hash.finalize().into()
    }

    /// The results of a part, if the part is undamaged.
    fn whole<'b>(&self, name: &str, bytes: &'b [u8]) -> Option<&'b [u8]> {
        let (answers, digest) = bytes.split_last_chunk::<DIGEST>()?;
        (*digest == self.digest(name, answers)).then_some(answers)
    }

    /// Stores the results, and removes the remains of killed processes.
    pub(crate) fn finish(&self, result: &Value) -> anyhow::Result<()> {
        self.folder.publish(Path::new(RESULT), &serde_json::to_vec_pretty(result)?)?;
        self.folder.tidy(&[PARTS, "."]);
        Ok(())
    }

    fn part(&self, name: &str) -> PathBuf {
        self.folder.path().join(PARTS).join(name)
    }
}

/// Describes the difference between the stored request and the current one.
fn difference(there: &Value, now: &Value) -> Option<&'static str> {
    if there["asked"] != now["asked"] {
        Some("computed with different arguments")
    } else if there["program"] != now["program"] {
        Some("computed by a different tankops or with different plugins")
    } else {
        None
    }
}

impl Parts for StudyFolder {
    fn place(&self, name: &str) -> String {
        self.part(name).display().to_string()
    }

    fn read(&self, name: &str) -> Result<Option<Vec<u8>>, String> {
        let bytes = self.folder.read(&Path::new(PARTS).join(name)).map_err(|error| error.to_string())?;
        let Some(bytes) = bytes else { return Ok(None) };
        let answers = self.whole(name, &bytes).map(<[u8]>::to_vec);
        if answers.is_none() {
            let why = "is damaged: its checksum does not match; recomputing it";
            warn_line(&format!("{} {why}", self.place(name)));
        }
        Ok(answers)
    }

    fn claim(&self, name: &str) -> bool {
        self.folder.claim(name)
    }

    fn wait_for(&self, name: &str) {
        if !self.has_waited.swap(true, Ordering::Relaxed) {
            let (place, claim) = (self.place(name), self.folder.claim_file(name));
            let until = "until it has finished or ended, or has been silent for 10 min";
            warn_line(&format!(
                "another process is computing {place} (see {}); waiting {until}",
                claim.display()
            ));
        }
    }

    fn keep_claim(&self, name: &str) {
        self.folder.keep_claim(name);
    }

    fn release(&self, name: &str) {
        self.folder.release(name);
    }

    fn publish(&self, name: &str, bytes: &[u8]) -> Result<(), String> {
        let whole = [bytes, &self.digest(name, bytes)].concat();
        self.folder
            .publish(&Path::new(PARTS).join(name), &whole)
            .map_err(|error| error.root_cause().to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(path: &Path, asked: &str) -> StudyFolder {
        let folder = SharedFolder::new(path);
        folder.make(&[PARTS]).expect("a folder");
        StudyFolder { folder, asked: asked.to_owned(), has_waited: AtomicBool::new(false) }
    }

    #[test]
    fn a_part_that_was_changed_cut_or_moved_is_not_there() {
        let here = tempfile::tempdir().expect("a folder");
        let study = folder(here.path(), "this");
        let name = "part-00000-00001.cbor";
        study.publish(name, b"answers").expect("written");
        assert_eq!(study.read(name), Ok(Some(b"answers".to_vec())));
        let file = study.part(name);
        let whole = std::fs::read(&file).expect("read");
        let with = |bytes: &[u8]| {
            std::fs::write(&file, bytes).expect("written");
            study.read(name)
        };
        for at in 0..whole.len() {
            let mut changed = whole.clone();
            changed[at] ^= 1 << (at % 8);
            assert_eq!((with(&changed), with(&whole[..at])), (Ok(None), Ok(None)), "{at}");
        }
        assert_eq!(with(&whole), Ok(Some(b"answers".to_vec())));
        assert_eq!(folder(here.path(), "that").read(name), Ok(None), "of another study");
        std::fs::copy(&file, study.part("part-00000-00002.cbor")).expect("copied");
        assert_eq!(study.read("part-00000-00002.cbor"), Ok(None), "of other cases");
    }
}
