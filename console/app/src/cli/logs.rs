//! The folder of the runs.

use clap::Args;
use planner_host::user_folder;
use std::path::PathBuf;

/// The option for the folder of the runs.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct LogsArg {
    /// Folder for runs; default: `logs` if it exists in the current folder, else `$XDG_STATE_HOME/tankops/logs`.
    #[arg(long, value_name = "DIR")]
    pub logs: Option<PathBuf>,
}

impl LogsArg {
    /// The folder of the runs.
    pub(crate) fn folder(&self) -> PathBuf {
        let here = PathBuf::from("logs");
        let of_user = || user_folder("XDG_STATE_HOME", ".local/state").map(|folder| folder.join("logs"));
        let by_default = || if here.is_dir() { here.clone() } else { of_user().unwrap_or(here.clone()) };
        self.logs.clone().unwrap_or_else(by_default)
    }
}
