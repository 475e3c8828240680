//! The scenario that a command line names.

use crate::{
    cli::{Changes, ConsoleArgs},
    failure::bad_input,
};
use scenario::{Scenario, Settings};
use std::path::Path;

/// The demo, so that `tankops` shows something wherever it is started.
const DEMO: &str = include_str!("../../../scenarios/demo.toml");

/// The demo.
pub(crate) fn demo() -> anyhow::Result<Scenario> {
    Scenario::parse(DEMO, "the demo scenario").map_err(|errors| bad_input(errors.render()))
}

/// The scenario to open the console on.
pub(crate) fn of_console(args: &ConsoleArgs) -> anyhow::Result<Scenario> {
    match &args.scenario {
        Some(path) => read(path, &args.changes),
        None => Scenario::parse_with(DEMO, "the demo scenario", &settings(&args.changes))
            .map_err(|errors| bad_input(errors.render())),
    }
}

/// Reads a scenario with what the command line changes in it.
pub(crate) fn read(path: &Path, changes: &Changes) -> anyhow::Result<Scenario> {
    Scenario::read_with(path, &settings(changes)).map_err(|errors| bad_input(errors.render()))
}

fn settings(changes: &Changes) -> Settings {
    Settings { planner: changes.planner.clone(), seed: changes.seed, set: changes.set.clone() }
}
