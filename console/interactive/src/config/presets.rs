//! Named parameter sets of planners: one file each, in the subfolder `presets` of the configuration folder.

use super::{
    fault::{Fault, Place, document, each, start},
    folder, name_of,
};
use anyhow::Context;
use mission::{ParamValue, Parameters, PlannerChoice, PlannerInfo, spelling::nearest};
use std::{
    fs::{self, File},
    io::Write,
    path::{Path, PathBuf},
};
use toml_edit::{DocumentMut, Item, Table};
use tui::model::{Preset, parameter};

/// The maximum size of a preset file, in bytes.
const LARGEST: u64 = 1 << 16;
/// The largest number of presets that are read.
const MOST: usize = 200;

/// Loads all presets, sorted by name.
pub(crate) fn load(planners: &[PlannerInfo]) -> Vec<Preset> {
    presets().map_or_else(Vec::new, |folder| load_from(&folder, planners))
}

/// Writes a preset to a new file and returns its path.
///
/// # Errors
/// The configuration folder is unknown, a preset with this name exists, or writing fails.
pub(crate) fn save(name: &str, choice: &PlannerChoice) -> anyhow::Result<PathBuf> {
    save_into(&presets().context("neither XDG_CONFIG_HOME nor HOME is set")?, name, choice)
}

fn presets() -> Option<PathBuf> {
    folder().map(|folder| folder.join("presets"))
}

fn save_into(folder: &Path, name: &str, choice: &PlannerChoice) -> anyhow::Result<PathBuf> {
    let file = folder.join(format!("{name}.toml"));
    let writing = || file.display().to_string();
    fs::create_dir_all(folder).with_context(writing)?;
    File::create_new(&file)
        .and_then(|mut file| file.write_all(text(choice).as_bytes()))
        .with_context(writing)?;
    Ok(file)
}

fn text(choice: &PlannerChoice) -> String {
    let mut parameters = Table::new();
    for (key, value) in &choice.parameters {
        let value = match value {
            ParamValue::Float(number) => (*number).into(),
            ParamValue::Int(number) => (*number).into(),
            ParamValue::Flag(flag) => (*flag).into(),
            ParamValue::Word(word) => word.clone().into(),
        };
        parameters.insert(key, Item::Value(value));
    }
    let mut document = DocumentMut::new();
    document.insert("planner", toml_edit::value(choice.id.clone()));
    document.insert("parameters", Item::Table(parameters));
    document.to_string()
}

fn load_from(folder: &Path, planners: &[PlannerInfo]) -> Vec<Preset> {
    let files = fs::read_dir(folder).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
    let mut files: Vec<PathBuf> =
        files.filter(|file| file.extension().is_some_and(|extension| extension == "toml")).collect();
    files.sort();
    files.truncate(MOST);
    let preset = |file: &PathBuf| Preset {
        name: file.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        choice: read_file(file, planners),
    };
    files.iter().map(preset).collect()
}

fn read_file(file: &Path, planners: &[PlannerInfo]) -> Result<PlannerChoice, String> {
    let name = name_of(file);
    let is_small = fs::metadata(file).is_ok_and(|data| data.is_file() && data.len() <= LARGEST);
    if !is_small {
        return Err(format!("{name}: larger than {LARGEST} bytes, or not a regular file"));
    }
    let text = fs::read_to_string(file).map_err(|error| format!("{name}: {error}"))?;
    let describe = |fault: &Fault| {
        let fault = Fault { instead: String::new(), ..fault.clone() };
        fault.text(Place { name: &name, text: &text })
    };
    read(&text, planners).map_err(|faults| faults.iter().map(describe).collect::<Vec<_>>().join("; "))
}

/// Reads a preset. Unlike a configuration file, a preset is accepted or refused as a whole.
fn read(text: &str, planners: &[PlannerInfo]) -> Result<PlannerChoice, Vec<Fault>> {
    let mut faults = Vec::new();
    let (mut id, mut parameters) = (None, None);
    let Some(document) = document(text, &mut faults) else { return Err(faults) };
    each(document.as_table(), &["planner", "parameters"], &mut faults, |key, item, _| {
        if key == "planner" {
            id = Some(item.as_str().ok_or("must be the id of a planner, in quotes")?.to_owned());
        } else {
            item.as_table_like().ok_or("must be a section")?;
            parameters = Some(item.clone());
        }
        Ok(())
    });
    let info = id.as_deref().map(|id| planners.iter().find(|info| info.id == id));
    let values = match (info, parameters.as_ref().and_then(Item::as_table_like)) {
        (None, _) => missing("planner", &mut faults),
        (_, None) => missing("parameters", &mut faults),
        (Some(None), _) => {
            let known: Vec<&str> = planners.iter().map(|info| info.id.as_str()).collect();
            let at = document.get("planner").map_or(0, start);
            faults.push(Fault::new(at, format!("planner must be one of: {}", known.join(", "))));
            Parameters::new()
        }
        (Some(Some(info)), Some(table)) => table
            .iter()
            .filter_map(|(key, item)| match value(info, key, item) {
                Ok(value) => Some((key.to_owned(), value)),
                Err(what) => {
                    faults.push(Fault::new(start(item), format!("{key}: {what}")));
                    None
                }
            })
            .collect(),
    };
    match id {
        Some(id) if faults.is_empty() => Ok(PlannerChoice { id, parameters: values }),
        _ => Err(faults),
    }
}

fn missing(key: &str, faults: &mut Vec<Fault>) -> Parameters {
    if faults.is_empty() {
        faults.push(Fault::new(0, format!("the key {key} is missing")));
    }
    Parameters::new()
}

fn value(info: &PlannerInfo, key: &str, item: &Item) -> Result<ParamValue, String> {
    let Some(found) = info.parameters.iter().find(|found| found.key == key) else {
        let near = nearest(key, info.parameters.iter().map(|found| found.key.as_str()));
        let near = near.map(|near| format!("; did you mean {near}?")).unwrap_or_default();
        return Err(format!("planner {} has no such parameter{near}", info.id));
    };
    let number = item.as_float().map(|number| number.to_string());
    let number = number.or_else(|| item.as_integer().map(|number| number.to_string()));
    let text = number.or_else(|| item.as_bool().map(|flag| flag.to_string()));
    let text = text.or_else(|| item.as_str().map(str::to_owned));
    parameter::parse(found, &text.ok_or_else(|| format!("allowed: {}", parameter::range(found)))?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mission::{ParamInfo, ParamKind};

    fn planner() -> PlannerInfo {
        let parameter = |key: &str, kind| ParamInfo {
            key: key.into(),
            label: String::new(),
            unit: String::new(),
            help: String::new(),
            group: String::new(),
            kind,
            live: false,
        };
        let options = vec!["literal".into(), "gated".into()];
        PlannerInfo {
            id: "rpf".into(),
            name: String::new(),
            version: "1".into(),
            about: String::new(),
            plugin: String::new(),
            sha256: String::new(),
            abi: String::new(),
            sandbox: None,
            covers: false,
            snapshots: false,
            parameters: vec![
                parameter("k_rep", ParamKind::Float { min: 0.0, max: 4.0, default: 1.0 }),
                parameter("steps", ParamKind::Int { min: 1, max: 9, default: 3 }),
                parameter("lanes", ParamKind::Flag { default: false }),
                parameter("mode", ParamKind::Choice { options, default: "gated".into() }),
            ],
        }
    }

    fn choice() -> PlannerChoice {
        let parameters = [
            ("k_rep", ParamValue::Float(2.0)),
            ("steps", ParamValue::Int(4)),
            ("lanes", ParamValue::Flag(true)),
            ("mode", ParamValue::Word("literal".into())),
        ];
        let parameters = parameters.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
        PlannerChoice { id: "rpf".into(), parameters }
    }

    #[test]
    fn a_preset_is_read_as_it_was_saved_and_never_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path().join("presets");
        assert_eq!(load_from(&folder, &[planner()]), [], "there is none at first");
        save_into(&folder, "soft", &choice()).expect("a new file");
        let preset = Preset { name: "soft".into(), choice: Ok(choice()) };
        assert_eq!(load_from(&folder, &[planner()]), [preset]);
        assert!(save_into(&folder, "soft", &choice()).is_err(), "it already exists");
    }

    #[test]
    fn a_faulty_preset_is_refused_with_file_line_and_key() {
        let cases = [
            ("planner = ", "soft.toml:1:11: invalid TOML"),
            ("[parameters]\n", "soft.toml:1:1: the key planner is missing"),
            ("planner = \"rpf\"\n", "soft.toml:1:1: the key parameters is missing"),
            ("planner = \"rfp\"\n[parameters]\n", "soft.toml:1:11: planner must be one of: rpf"),
            (
                "planner = \"rpf\"\n[parameters]\nk_rep = 9\n",
                "soft.toml:3:9: k_rep: 9 is out of range; allowed: 0 to 4",
            ),
            (
                "planner = \"rpf\"\n[parameters]\nk_reb = 1.0\n",
                "soft.toml:3:9: k_reb: planner rpf has no such parameter; did you mean k_rep?",
            ),
            ("planner = \"rpf\"\nparameter = 1\n[parameters]\n", "soft.toml:2:1: unknown key"),
        ];
        for (text, why) in cases {
            let folder = tempfile::tempdir().expect("a folder");
            fs::write(folder.path().join("soft.toml"), text).expect("writable");
            let read = load_from(folder.path(), &[planner()]).remove(0).choice;
            assert!(read.as_ref().is_err_and(|said| said.starts_with(why)), "{text}: {read:?}");
        }
    }
}
