//! The folder of a study or a search: what was asked for, and the answers so far. The same command with the same folder
//! resumes, and shares the work with those that run at the same time.

use crate::{campaign::Here, shared_folder::SharedFolder};
use flight::failure::bad_input;
use planner_host::PluginDirs;
use report::print::warn_line;
use reproduce::Parts;
use serde_json::Value;
use std::{
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
};

/// What was asked for, and with which program.
const FROZEN: &str = "study.json";
const PARTS: &str = "parts";
/// Results, when everything is there.
const RESULT: &str = "result.json";

/// A folder of answers.
pub(crate) struct StudyFolder {
    folder: SharedFolder,
    /// Whether it was said that others are waited for.
    has_waited: AtomicBool,
}

impl StudyFolder {
    /// The folder for what is asked for with the planners and the program that are here, which is made if there is none.
    pub(crate) fn open(path: &Path, asked: &Value, plugins: &PluginDirs) -> anyhow::Result<Self> {
        let folder = SharedFolder::new(path);
        folder.make(&[PARTS]).map_err(|error| bad_input(format!("--out {error:#}")))?;
        let asked = serde_json::json!({ "asked": asked, "program": Here::survey(plugins)?.program });
        let refused = |why: &str| bad_input(format!("--out {}: {why}", path.join(FROZEN).display()));
        match folder.read(Path::new(FROZEN)).map_err(|error| refused(&error.to_string()))? {
            None => folder.publish(Path::new(FROZEN), &serde_json::to_vec_pretty(&asked)?)?,
            Some(there) => match serde_json::from_slice(&there) {
                Err(error) => return Err(refused(&format!("{error}; choose another folder"))),
                Ok(there) => difference(&there, &asked).map_or(Ok(()), |what| {
                    Err(refused(&format!("the folder holds answers {what}; choose another one")))
                })?,
            },
        }
        Ok(Self { folder, has_waited: AtomicBool::new(false) })
    }

    /// Keeps the results, and removes what killed processes have left.
    pub(crate) fn finish(&self, result: &Value) -> anyhow::Result<()> {
        self.folder.publish(Path::new(RESULT), &serde_json::to_vec_pretty(result)?)?;
        self.folder.tidy(&[PARTS, "."]);
        Ok(())
    }

    fn part(&self, name: &str) -> PathBuf {
        self.folder.path().join(PARTS).join(name)
    }
}

/// How what is there differs from what is asked for now.
fn difference(there: &Value, now: &Value) -> Option<&'static str> {
    if there["asked"] != now["asked"] {
        Some("to other arguments")
    } else if there["program"] != now["program"] {
        Some("of another tankops or other plugins")
    } else {
        None
    }
}

impl Parts for StudyFolder {
    fn place(&self, name: &str) -> String {
        self.part(name).display().to_string()
    }

    fn read(&self, name: &str) -> Result<Option<Vec<u8>>, String> {
        self.folder.read(&Path::new(PARTS).join(name)).map_err(|error| error.to_string())
    }

    fn claim(&self, name: &str) -> bool {
        self.folder.claim(name)
    }

    fn wait_for(&self, name: &str) {
        if !self.has_waited.swap(true, Ordering::Relaxed) {
            let (place, claim) = (self.place(name), self.folder.claim_file(name));
            let until = "until it has done so, has ended, or has been silent for 10 min";
            warn_line(&format!("waiting for {place}: {} says who computes it, {until}", claim.display()));
        }
    }

    fn keep_claim(&self, name: &str) {
        self.folder.keep_claim(name);
    }

    fn release(&self, name: &str) {
        self.folder.release(name);
    }

    fn publish(&self, name: &str, bytes: &[u8]) -> Result<(), String> {
        self.folder
            .publish(&Path::new(PARTS).join(name), bytes)
            .map_err(|error| error.root_cause().to_string())
    }
}
