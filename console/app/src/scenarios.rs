//! The scenario that a command line names.

use crate::{cli::Changes, failure::bad_input};
use scenario::{Scenario, Settings};
use std::path::Path;

/// The demo, so that `tankops` shows something wherever it is started.
const DEMO: &str = include_str!("../../../scenarios/demo.toml");

/// The demo.
pub(crate) fn demo() -> anyhow::Result<Scenario> {
    demo_with(&Changes::default())
}

/// The demo with what the command line changes in it.
pub(crate) fn demo_with(changes: &Changes) -> anyhow::Result<Scenario> {
    Scenario::parse_with(DEMO, "the demo scenario", &settings(changes))
        .map_err(|errors| bad_input(errors.render()))
}

/// Reads a scenario with what the command line changes in it.
pub(crate) fn read(path: &Path, changes: &Changes) -> anyhow::Result<Scenario> {
    Scenario::read_with(path, &settings(changes)).map_err(|errors| bad_input(errors.render()))
}

fn settings(changes: &Changes) -> Settings {
    Settings { planner: changes.planner.clone(), seed: changes.seed, set: changes.set.clone() }
}
