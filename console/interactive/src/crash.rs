//! What is kept when the screen itself fails.

use anyhow::anyhow;
use runs::utc;
use std::{path::Path, time::SystemTime};
use tui::Model;

/// Writes what the screen knew beside the runs; the error says where, and that the run was closed.
///
/// The file is a model as JSON: it can be opened in a test of the screen.
pub(super) fn report(logs: &Path, model: &Model) -> anyhow::Error {
    let name = format!("crash-{}.json", utc(SystemTime::now()));
    let path = logs.join(name);
    let kept = serde_json::to_vec(model).map_err(anyhow::Error::from).and_then(|text| {
        std::fs::create_dir_all(logs)?;
        Ok(std::fs::write(&path, text)?)
    });
    match kept {
        Ok(()) => {
            anyhow!("the screen failed; the run was closed, what the screen knew is in {}", path.display())
        }
        Err(error) => {
            anyhow!("the screen failed; the run was closed, but no crash report could be written: {error}")
        }
    }
}
