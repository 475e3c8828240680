//! Changes to a scenario from the command line.

use clap::Args;
use scenario::Settings;

/// The changes to a scenario from the command line.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct Changes {
    /// Planner to use instead of the scenario's.
    #[arg(long, value_name = "ID")]
    pub planner: Option<String>,
    /// Set a planner parameter (`k_rep=2`) or any key of the scenario (`mission.swath_m=0.5`).
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Random seed to use instead of the scenario's.
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
}

impl From<&Changes> for Settings {
    fn from(changes: &Changes) -> Self {
        let Changes { planner, set, seed } = changes.clone();
        Self { set, planner, seed }
    }
}
