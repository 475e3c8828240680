//! Scenario files: one TOML text that says everything about a run.
//!
//! [`Scenario::read_with`] takes a file, [`Scenario::parse`] a text. What comes out has been checked: the engine and the
//! simulator need not doubt it. What is wrong comes back as [`ScenarioErrors`], all of it at once, each problem with
//! line, column, key, value and remedy; [`ScenarioErrors::render`] shows it. Settings from the command line are put
//! into the text before it is read, so that the text alone gives the same scenario again.

mod assemble;
mod checks;
mod expect;
mod floor;
mod inspection;
mod layout;
mod map;
mod outline;
mod planner_keys;
mod problem;
mod ranging;
mod readable;
mod render;
mod rescan;
mod robot;
mod schema;
mod section;
mod settings;
mod source;
mod suggest;
mod task;
mod tether;

pub use inspection::inspection;
pub use problem::{Complaint, Problem, ScenarioErrors};
pub use rescan::{Continued, rescan};
pub use settings::Settings;

use account::{Expect, Inspection};
use mission::MissionConfig;
use sim::SimConfig;
use source::Source;
use std::{io::Read, path::Path};
use toml::de::DeTable;
use world::PlateLayout;

/// A larger file is not a scenario, kilobytes; a large map written out takes some two thousand.
const LIMIT_KB: usize = 8000;

/// A scenario, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// What it is called; part of file names.
    pub name: String,
    /// What it shows, for people; may be empty.
    pub about: String,
    /// The file, or what else it is called in messages.
    pub shown_name: String,
    /// The text it was read from, with settings already put in; gives the same scenario again.
    pub text: String,
    /// Start of every random choice.
    pub seed: u64,
    /// What is simulated.
    pub sim: SimConfig,
    /// What is to be done.
    pub mission: MissionConfig,
    /// How the plates of the floor lie, if the drawing specifies it.
    pub plates: Option<PlateLayout>,
    /// What the operator ticks by hand before the start.
    pub checklist: Vec<String>,
    /// Bounds that the run is held to.
    pub expect: Expect,
    /// What only people know of the inspection.
    pub inspection: Inspection,
}

impl Scenario {
    /// Reads a scenario file, `-` being the standard input, and puts settings from the command line into it.
    ///
    /// # Errors
    /// Everything that is wrong with it or with the settings.
    pub fn read_with(path: &Path, settings: &Settings) -> Result<Self, ScenarioErrors> {
        let shown_name =
            if is_stdin(path) { "standard input".to_owned() } else { path.display().to_string() };
        let text = read_text(path).map_err(|what| ScenarioErrors::of_file(&shown_name, what))?;
        let (text, shown_name) = with_settings(&text, &shown_name, settings)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse(&map::put_in(&text, &shown_name, folder)?, &shown_name)
    }

    /// Reads a scenario from its text; `shown_name` is what messages call it.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn parse(text: &str, shown_name: &str) -> Result<Self, ScenarioErrors> {
        Self::checked(text, shown_name, readable::check)
    }

    /// Reads the scenario of a past run from its text, which was accepted then: older runs have names that would be refused now.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn recorded(text: &str, shown_name: &str) -> Result<Self, ScenarioErrors> {
        Self::checked(text, shown_name, |_, _| {})
    }

    fn checked(
        text: &str,
        shown_name: &str,
        also: fn(&Source<'_>, &DeTable<'_>),
    ) -> Result<Self, ScenarioErrors> {
        if text.len() > LIMIT_KB * 1000 {
            return Err(ScenarioErrors::of_file(shown_name, Complaint::TooLarge { limit_kb: LIMIT_KB }));
        }
        let table = DeTable::parse(text).map_err(|error| syntax_error(text, shown_name, &error))?;
        assemble::assemble(text, shown_name, table.get_ref(), also).map_err(|problems| ScenarioErrors {
            shown_name: shown_name.to_owned(),
            text: text.to_owned(),
            problems,
        })
    }

    /// Reads a scenario from its text after putting settings into it.
    ///
    /// # Errors
    /// Everything that is wrong with it or with the settings.
    pub fn parse_with(text: &str, shown_name: &str, settings: &Settings) -> Result<Self, ScenarioErrors> {
        let (text, shown_name) = with_settings(text, shown_name, settings)?;
        Self::parse(&text, &shown_name)
    }
}

/// The text with the settings in it, and what messages call it.
fn with_settings(
    text: &str,
    shown_name: &str,
    settings: &Settings,
) -> Result<(String, String), ScenarioErrors> {
    if settings.is_empty() {
        return Ok((text.to_owned(), shown_name.to_owned()));
    }
    DeTable::parse(text).map_err(|error| syntax_error(text, shown_name, &error))?;
    let changed = settings.put_into(text).map_err(|what| ScenarioErrors::of_file(shown_name, what))?;
    Ok((changed, format!("{shown_name} with {settings}")))
}

fn read_text(path: &Path) -> Result<String, Complaint> {
    let unreadable = |error: std::io::Error| Complaint::Unreadable(error.to_string());
    let mut bytes = Vec::new();
    let limit = LIMIT_KB as u64 * 1000 + 1;
    if is_stdin(path) {
        std::io::stdin().take(limit).read_to_end(&mut bytes).map_err(unreadable)?;
    } else {
        foreign::open_waiting(path)
            .map_err(unreadable)?
            .take(limit)
            .read_to_end(&mut bytes)
            .map_err(unreadable)?;
    }
    if bytes.len() > LIMIT_KB * 1000 {
        return Err(Complaint::TooLarge { limit_kb: LIMIT_KB });
    }
    match foreign::NotUtf8::of(&bytes) {
        Some(foreign) => Err(Complaint::NotText(foreign)),
        None => Ok(String::from_utf8_lossy(&bytes).into_owned()),
    }
}

/// Whether a path stands for the standard input, as `-` does.
pub fn is_stdin(path: &Path) -> bool {
    path == Path::new("-")
}

fn syntax_error(text: &str, shown_name: &str, error: &toml::de::Error) -> ScenarioErrors {
    let message: String = error.message().lines().next().unwrap_or_default().chars().take(120).collect();
    let problem =
        Problem { key: String::new(), value: None, at: error.span(), what: Complaint::NotToml(message) };
    ScenarioErrors { shown_name: shown_name.to_owned(), text: text.to_owned(), problems: vec![problem] }
}

#[cfg(test)]
mod tests;
