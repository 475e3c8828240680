//! Reads the scenario named on the command line.

use crate::failure::bad_input;
use scenario::{Scenario, Settings, is_stdin};
use std::path::{Path, PathBuf};

/// The built-in demo, so that `tankops` has something to show whatever folder it is started in.
const DEMO: &str = include_str!("../../../scenarios/demo.toml");

/// The demo, with the settings from the command line applied.
///
/// # Errors
/// Every objection to these settings.
pub fn demo(settings: &Settings) -> anyhow::Result<Scenario> {
    Scenario::parse_with(DEMO, "the demo scenario", settings).map_err(|errors| bad_input(errors.render()))
}

/// Reads a scenario from a path, from standard input (`-`), or by the name listed on the home screen: `cover-circle`
/// stands for `scenarios/cover-circle.toml`.
///
/// # Errors
/// Every objection, with its place in the file.
pub fn read(path: &Path, settings: &Settings) -> anyhow::Result<Scenario> {
    match file_of(path)? {
        Some(file) => read_file(&file, settings),
        None => demo(settings),
    }
}

/// The file that a path, standard input (`-`) or a name listed on the home screen stands for; `None` for the built-in
/// demo.
///
/// # Errors
/// Neither the path nor a file with this name exists.
pub fn file_of(path: &Path) -> anyhow::Result<Option<PathBuf>> {
    match listed(path).filter(|_| !path.exists() && !is_stdin(path)) {
        Some(file) if file.exists() => Ok(Some(file)),
        Some(_) if path == Path::new("demo") => Ok(None),
        Some(file) => Err(bad_input(format!(
            "{}: there is no such file, and no {} either; give the path of a scenario, or a name from the home screen",
            path.display(),
            file.display()
        ))),
        None => Ok(Some(path.to_owned())),
    }
}

/// The path of the scenario file for a name that has neither folder nor extension.
fn listed(name: &Path) -> Option<PathBuf> {
    let is_bare = name.components().count() == 1 && name.file_name().is_some() && name.extension().is_none();
    is_bare.then(|| Path::new("scenarios").join(name).with_extension("toml"))
}

fn read_file(path: &Path, settings: &Settings) -> anyhow::Result<Scenario> {
    Scenario::read_with(path, settings).map_err(|errors| bad_input(errors.render()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn a_scenario_is_named_by_path_or_as_the_home_screen_lists_it() {
        assert_eq!(listed(Path::new("cover-circle")), Some("scenarios/cover-circle.toml".into()));
        for path in ["cover-circle.toml", "tanks/a", "/a", "..", ""] {
            assert_eq!(listed(Path::new(path)), None, "{path}");
        }
        assert_eq!(read(Path::new("demo"), &Settings::default()).unwrap().name, "demo");
        assert_eq!(file_of(Path::new("demo")).unwrap(), None);
        assert_eq!(file_of(Path::new("Cargo.toml")).unwrap(), Some("Cargo.toml".into()));
        let error = read(Path::new("no-such-tank"), &Settings::default()).unwrap_err().to_string();
        assert!(error.contains("no scenarios/no-such-tank.toml either"), "{error}");
    }
}
