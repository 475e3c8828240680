//! Readings of an instrument that were imported into the folder of a run.

use crate::whole::write_whole;
use account::{Fold, Imported};
use foreign::read_json;
use recording::{READINGS_FILE, each_reading};
use report::ImportedReadings;
use std::{fs, io, path::Path};

/// Describes the import beside the readings.
pub const IMPORT_FILE: &str = "readings.json";
/// Maximum length of that file, bytes.
const MOST_BYTES: u64 = 1 << 20;

/// Writes the description of an import into the folder of a run.
///
/// # Errors
/// The system refuses to write the file.
pub fn write_import(folder: &Path, import: &ImportedReadings) -> io::Result<()> {
    let text = serde_json::to_string_pretty(import).map_err(io::Error::other)? + "\n";
    write_whole(&folder.join(IMPORT_FILE), text.as_bytes())
}

/// The description of the import into a run, and what the readings show. Floor under channels that gave no readings is
/// taken back from the account; `None` if nothing was imported.
///
/// # Errors
/// The reason why the readings cannot be used, as a sentence.
pub(crate) fn imported(
    folder: &Path,
    fold: &mut Fold,
) -> Result<Option<(ImportedReadings, Imported)>, String> {
    let file = folder.join(IMPORT_FILE);
    if fold.survey().is_some() {
        return Ok(None);
    }
    if !fs::exists(&file).unwrap_or(false) {
        let is_left = fs::exists(folder.join(READINGS_FILE)).unwrap_or(false);
        let why = format!(
            "{READINGS_FILE} does not belong to this run, because {IMPORT_FILE} is missing; import the readings again"
        );
        return if is_left { Err(why) } else { Ok(None) };
    }
    let unread = |error: &dyn std::fmt::Display| format!("{IMPORT_FILE} cannot be read: {error}");
    let text = read_json(&file, MOST_BYTES).map_err(|error| unread(&error))?;
    let import: ImportedReadings = serde_json::from_str(&text).map_err(|error| unread(&error))?;
    let sampling = fold.run().and_then(|run| run.mission.instrument.as_ref()?.sampling);
    fold.silence(&import.silences);
    let (Some(sampling), Some(scanned)) = (sampling, fold.scanned()) else {
        return Err(
            "readings were imported, but the scenario of the run has no [instrument] with channels".into()
        );
    };
    let floor = scanned.believed().floor();
    let mut imported = Imported::new(sampling, floor);
    let read = each_reading(&folder.join(READINGS_FILE), |reading| {
        imported.add(floor, reading);
    });
    read.map_err(|error| format!("the imported readings: {error}"))?;
    Ok(Some((import, imported)))
}
