//! What the operator has set up: `config.toml` and `keys.toml` in the XDG configuration folder.

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

/// Name of the file of settings.
const SETTINGS: &str = "config.toml";
/// Name of the file of keys.
const KEYS: &str = "keys.toml";

/// What the operator has set up.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Config {
    /// The colours; `None`: by the terminal's background.
    pub theme: Option<ThemeName>,
    /// How many colours; `None`: as many as the terminal has.
    pub colours: Option<Colours>,
    /// Folders of scenarios for the home screen.
    pub scenarios: Vec<PathBuf>,
    /// Speed of a simulation at first.
    pub speed: Speed,
    /// What the screen itself needs to know.
    pub preferences: Preferences,
    /// Keys and short names of commands.
    pub keys: Keymap,
    /// What is wrong with the files, for the home screen.
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
    /// Reads both files; what is missing or faulty leaves its default.
    pub(crate) fn load() -> Self {
        let Some(folder) = folder() else { return Self::default() };
        let mut config = Self::default();
        let settings = config.take(&folder.join(SETTINGS), settings::read);
        let keys = config.take(&folder.join(KEYS), keys::read);
        config.attention = settings.into_iter().chain(keys).collect();
        config
    }

    /// A model with what the operator has set up.
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

/// Reads the text of a file into the configuration.
type Read = fn(&mut Config, &str) -> Vec<Fault>;

fn attention_to(fault: &Fault, name: &str, text: &str) -> Attention {
    let severity = if fault.is_warning { Severity::Watch } else { Severity::Warn };
    point(severity, fault.text(Place { name, text }))
}

fn point(severity: Severity, text: String) -> Attention {
    Attention { severity, kind: "CONFIG".into(), text }
}

fn folder() -> Option<PathBuf> {
    user_folder("XDG_CONFIG_HOME", ".config")
}

fn name_of(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Whether a file is one of the two by its name.
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

/// Checks a file if it is one of the two by its name; what it holds.
///
/// # Errors
/// What is wrong with it, a line each.
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
