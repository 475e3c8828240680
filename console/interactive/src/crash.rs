//! The crash report of the screen.

use anyhow::anyhow;
use runs::utc;
use std::{path::Path, time::SystemTime};
use tui::Model;

/// Writes the state of the screen to the folder of the runs. Returns an error that names the file and states that the
/// run was closed.
///
/// The file contains the model as JSON; a test of the screen can open it.
pub(super) fn report(logs: &Path, model: &Model) -> anyhow::Error {
    let name = format!("crash-{}.json", utc(SystemTime::now()));
    let path = logs.join(name);
    let kept = serde_json::to_vec(model).map_err(anyhow::Error::from).and_then(|text| {
        std::fs::create_dir_all(logs)?;
        Ok(std::fs::write(&path, text)?)
    });
    match kept {
        Ok(()) => {
            anyhow!(
                "the screen failed; the run was closed, and the state of the screen was saved in {}",
                path.display()
            )
        }
        Err(error) => {
            anyhow!(
                "the screen failed; the run was closed, but the crash report could not be written: {error}"
            )
        }
    }
}
