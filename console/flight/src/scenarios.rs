//! The scenario that a command line names.

use crate::failure::bad_input;
use scenario::{Scenario, Settings};
use std::path::Path;

/// The demo, so that `tankops` shows something wherever it is started.
const DEMO: &str = include_str!("../../../scenarios/demo.toml");

/// The demo, with what the command line changes about it.
///
/// # Errors
/// Every objection to the changes.
pub fn demo(settings: &Settings) -> anyhow::Result<Scenario> {
    Scenario::parse_with(DEMO, "the demo scenario", settings).map_err(|errors| bad_input(errors.render()))
}

/// Reads a scenario, with what the command line changes about it.
///
/// # Errors
/// Every objection, with its place in the file.
pub fn read(path: &Path, settings: &Settings) -> anyhow::Result<Scenario> {
    Scenario::read_with(path, settings).map_err(|errors| bad_input(errors.render()))
}
