//! The operator's configuration: `config.toml` and `keys.toml` in the XDG configuration folder.

mod fault;
mod keys;
pub(crate) mod presets;
mod settings;

pub use settings::colours;

use fault::{Fault, Place};
use flight::texts;
use mission::Severity;
use planner_host::user_folder;
use std::path::{Path, PathBuf};
use tui::{
    Colours, Model, Speed, ThemeName,
    actions::keymap::Keymap,
    model::{console::Preferences, home::Attention},
};

/// The name of the settings file.
const SETTINGS: &str = "config.toml";
/// The name of the key-bindings file.
const KEYS: &str = "keys.toml";

/// The operator's configuration.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Config {
    /// The colour theme; `None` to choose a theme that suits the terminal's background.
    pub theme: Option<ThemeName>,
    /// The number of colours; `None` to use as many as the terminal supports.
    pub colours: Option<Colours>,
    /// The scenario folders of the home screen.
    pub scenarios: Vec<PathBuf>,
    /// The initial speed of a simulation.
    pub speed: Speed,
    /// The settings that the screen uses.
    pub preferences: Preferences,
    /// Key bindings and aliases of commands.
    pub keys: Keymap,
    /// Problems in the files, for the home screen.
    pub attention: Vec<Attention>,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            theme: None,
            colours: None,
            scenarios: vec!["scenarios".into()],
            speed: Speed::default(),
            preferences: Preferences::default(),
            keys: Keymap::default(),
            attention: Vec::new(),
        }
    }
}

impl Config {
    /// Reads both files; for a missing or faulty entry, the default stays in effect.
    pub(crate) fn load() -> Self {
        let Some(folder) = folder() else { return Self::default() };
        let mut config = Self::default();
        let settings = config.take(&folder.join(SETTINGS), settings::read);
        let keys = config.take(&folder.join(KEYS), keys::read);
        config.attention = settings.into_iter().chain(keys).collect();
        config
    }

    /// Applies the configuration to a model.
    pub(crate) fn apply(&self, mut model: Model) -> Model {
        let background = std::env::var("COLORFGBG").ok();
        model.ui.theme = self.theme.unwrap_or_else(|| ThemeName::for_background(background.as_deref()));
        model.ui.mouse = self.preferences.mouse;
        (model.console.keys, model.console.preferences) = (self.keys.clone(), self.preferences.clone());
        model
    }

    fn take(&mut self, file: &Path, read: Read) -> Vec<Attention> {
        let text = match texts::read_regular(file) {
            Ok(text) => text,
            Err(_) if !file.exists() => return Vec::new(),
            Err(error) => return vec![point(Severity::Warn, error.to_string())],
        };
        let name = name_of(file);
        read(self, &text).iter().map(|fault| attention_to(fault, &name, &text)).collect()
    }
}

/// Reads the text of a file into the configuration; returns the faults in the text.
type Read = fn(&mut Config, &str) -> Vec<Fault>;

fn attention_to(fault: &Fault, name: &str, text: &str) -> Attention {
    let severity = if fault.is_warning { Severity::Watch } else { Severity::Warn };
    point(severity, fault.text(Place { name, text }))
}

fn point(severity: Severity, text: String) -> Attention {
    Attention { severity, kind: "CONFIG".into(), text, run: None }
}

fn folder() -> Option<PathBuf> {
    user_folder("XDG_CONFIG_HOME", ".config")
}

fn name_of(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Whether a file has the name of a configuration file.
pub fn is_one(file: &Path) -> bool {
    reader_of(file).is_some()
}

fn reader_of(file: &Path) -> Option<Read> {
    match file.file_name()?.to_str()? {
        SETTINGS => Some(settings::read),
        KEYS => Some(keys::read),
        _ => None,
    }
}

/// Checks a file if it has the name of a configuration file; returns a description.
///
/// # Errors
/// The faults in the file, one per line.
pub fn check(file: &Path) -> Option<Result<String, String>> {
    let read = reader_of(file)?;
    let text = match texts::read_regular(file) {
        Ok(text) => text,
        Err(error) => return Some(Err(format!("error: {error}"))),
    };
    let name = file.display().to_string();
    let faults = read(&mut Config::default(), &text);
    let is_sound = faults.iter().all(|fault| fault.is_warning);
    let said = faults.iter().map(|fault| {
        let word = if fault.is_warning { "warning" } else { "error" };
        format!("{word}: {}", fault.text(Place { name: &name, text: &text }))
    });
    let said: Vec<String> = said.collect();
    Some(match (is_sound, said.is_empty()) {
        (true, true) => Ok("configuration".into()),
        (true, false) => Ok(format!("configuration\n{}", said.join("\n"))),
        (false, _) => Err(said.join("\n")),
    })
}

#[cfg(test)]
mod tests;
