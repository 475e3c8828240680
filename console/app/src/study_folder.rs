//! The folder of a study or a search: what was asked for, and the answers so far. The same command with the same folder
//! resumes, and shares the work with those that run at the same time.

use crate::{campaign::Here, shared_folder::SharedFolder};
use flight::failure::bad_input;
use planner_host::PluginDirs;
use reproduce::Parts;
use serde_json::Value;
use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// What was asked for, and with which program.
const FROZEN: &str = "study.json";
const PARTS: &str = "parts";
/// Results, when everything is there.
const RESULT: &str = "result.json";

/// A folder of answers.
pub(crate) struct StudyFolder(SharedFolder);

impl StudyFolder {
    /// The folder for what is asked for with the planners and the program that are here, which is made if there is none.
    pub(crate) fn open(path: &Path, asked: &Value, plugins: &PluginDirs) -> anyhow::Result<Self> {
        let folder = SharedFolder::new(path);
        folder.make(&[PARTS]).map_err(|error| bad_input(format!("--out {error:#}")))?;
        let asked = serde_json::json!({ "asked": asked, "program": Here::survey(plugins)?.program });
        let file = path.join(FROZEN);
        match fs::read(&file) {
            Ok(there) => {
                if let Some(what) = difference(&serde_json::from_slice(&there).unwrap_or_default(), &asked) {
                    let path = path.display();
                    return Err(bad_input(format!(
                        "--out {path} holds answers {what}; choose another folder"
                    )));
                }
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                folder.publish(Path::new(FROZEN), &serde_json::to_vec_pretty(&asked)?)?;
            }
            Err(error) => return Err(bad_input(format!("{}: {error}", file.display()))),
        }
        Ok(Self(folder))
    }

    /// Keeps the results, and removes what killed processes have left.
    pub(crate) fn finish(&self, result: &Value) -> anyhow::Result<()> {
        self.0.publish(Path::new(RESULT), &serde_json::to_vec_pretty(result)?)?;
        self.0.tidy(&[PARTS, "."]);
        Ok(())
    }

    fn part(&self, name: &str) -> PathBuf {
        self.0.path().join(PARTS).join(name)
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
        match fs::read(self.part(name)) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error.to_string()),
        }
    }

    fn claim(&self, name: &str) -> bool {
        self.0.claim(name)
    }

    fn keep_claim(&self, name: &str) {
        self.0.keep_claim(name);
    }

    fn release(&self, name: &str) {
        self.0.release(name);
    }

    fn publish(&self, name: &str, bytes: &[u8]) -> Result<(), String> {
        self.0.publish(&Path::new(PARTS).join(name), bytes).map_err(|error| error.root_cause().to_string())
    }
}
