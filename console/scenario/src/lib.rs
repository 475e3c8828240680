//! Scenario files: one TOML text that states everything about a run.
//!
//! [`Scenario::read_with`] reads a file, and [`Scenario::parse`] a text. The result has been checked, so the engine and
//! the simulator can rely on it. All problems are reported together as [`ScenarioErrors`], each with its line, column,
//! key, value and remedy; [`ScenarioErrors::render`] formats them. Settings from the command line are written into the
//! text before it is parsed, so the resulting text alone reproduces the scenario.

mod as_written;
mod assemble;
mod checks;
mod expect;
mod floor;
mod inspection;
mod instrument;
mod layout;
mod map;
mod of_map;
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
mod vehicle;
mod wear;

pub use inspection::inspection;
pub use of_map::cover_of_map;
pub use problem::{Complaint, Problem, ScenarioErrors};
pub use rescan::{Continued, left_out_of_rescan, rescan};
pub use settings::Settings;
pub use vehicle::VehicleNeeds;

use account::{Expect, Inspection};
use mission::MissionConfig;
use sim::SimConfig;
use source::Source;
use std::{io::Read, path::Path};
use toml::de::DeTable;
use world::{FloorWear, PlateLayout};

/// The largest size of a scenario in kilobytes; a scenario with a large map is about two thousand kilobytes long.
const LIMIT_KB: usize = 8000;

/// A checked scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// The name; part of file names.
    pub name: String,
    /// A description for people; may be empty.
    pub about: String,
    /// The name that messages use: the file name, or a different name.
    pub shown_name: String,
    /// The text of the scenario after settings have been applied; it reproduces the scenario.
    pub text: String,
    /// The seed for all random numbers.
    pub seed: u64,
    /// The simulated world.
    pub sim: SimConfig,
    /// The mission to run.
    pub mission: MissionConfig,
    /// The layout of the floor plates, if the drawing specifies it.
    pub plates: Option<PlateLayout>,
    /// The true thickness of the floor, for simulated readings.
    pub wear: Option<FloorWear>,
    /// The requirements for a real vehicle.
    pub vehicle: VehicleNeeds,
    /// Items that the operator ticks by hand before the start.
    pub checklist: Vec<String>,
    /// Bounds on the run's results.
    pub expect: Expect,
    /// Facts that only people know about the inspection.
    pub inspection: Inspection,
}

impl Scenario {
    /// Reads a scenario file, or standard input for `-`, and applies settings from the command line.
    ///
    /// # Errors
    /// All problems in the scenario or the settings.
    pub fn read_with(path: &Path, settings: &Settings) -> Result<Self, ScenarioErrors> {
        let shown_name =
            if is_stdin(path) { "standard input".to_owned() } else { path.display().to_string() };
        let text = read_text(path).map_err(|what| ScenarioErrors::of_file(&shown_name, what))?;
        let (changed, shown_name) = with_settings(&text, &shown_name, settings)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let parsed =
            map::put_in(&changed, &shown_name, folder).and_then(|text| Self::parse(&text, &shown_name));
        parsed.map_err(|errors| settled(&text, settings, errors))
    }

    /// Parses a scenario; `shown_name` is its name in messages.
    ///
    /// # Errors
    /// All problems in the scenario.
    pub fn parse(text: &str, shown_name: &str) -> Result<Self, ScenarioErrors> {
        Self::checked(text, shown_name, readable::check)
    }

    /// Parses the scenario of a past run, which was accepted at that time. Older runs may have names that would be
    /// refused today.
    ///
    /// # Errors
    /// All problems in the scenario.
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

    /// Parses a scenario after applying settings to its text.
    ///
    /// # Errors
    /// All problems in the scenario or the settings.
    pub fn parse_with(text: &str, shown_name: &str, settings: &Settings) -> Result<Self, ScenarioErrors> {
        let (changed, shown_name) = with_settings(text, shown_name, settings)?;
        Self::parse(&changed, &shown_name).map_err(|errors| settled(text, settings, errors))
    }
}

/// The problems of a changed text with the lines of the text as it was written.
fn settled(text: &str, settings: &Settings, errors: ScenarioErrors) -> ScenarioErrors {
    if settings.is_empty() { errors } else { as_written::as_written(text, errors) }
}

/// Applies settings to a text; returns the changed text with its name for messages.
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

/// Whether a path refers to standard input, as `-` does.
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
