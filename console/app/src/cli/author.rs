//! Commands for authors of planners and adapters.

use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct NewPlannerArgs {
    /// Id of the planner: a letter, then up to 31 of a-z, 0-9, _ and -.
    pub name: String,
    /// Language of the planner.
    #[arg(long, value_name = "LANG", default_value = "rust")]
    pub lang: Lang,
    /// Folder in which to create the planner's folder.
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub out: PathBuf,
    /// Folder of the crate `planner-api` (Rust only); default: the crate installed with tankops, else the one that
    /// tankops was built with, else the published crate.
    #[arg(long, value_name = "DIR")]
    pub api: Option<PathBuf>,
}

/// The language of a new planner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Lang {
    /// Rust, with the crate `planner-api`.
    Rust,
    /// C11, with the header `tankops_planner.h`.
    C,
    /// C++17, with the same header.
    Cpp,
}

#[derive(Debug, Args)]
pub(crate) struct NewVehicleArgs {
    /// Name of the vehicle: a letter, then up to 31 of a-z, 0-9, _ and -.
    pub name: String,
    /// Language of the adapter.
    #[arg(long, value_name = "LANG", default_value = "python")]
    pub lang: VehicleLang,
    /// Folder in which to create the adapter's folder.
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub out: PathBuf,
}

/// The language of a new adapter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum VehicleLang {
    /// Python 3.8 or later, without packages.
    Python,
    /// Rust, with the crate `serde_json`.
    Rust,
}

#[derive(Debug, Args)]
pub(crate) struct ReplayWorkerArgs {
    /// Folder `crash-N` inside a run folder.
    #[arg(value_name = "BUNDLE")]
    pub bundle: PathBuf,
    /// Run the plugin's process in gdb, without deadlines.
    #[arg(long, conflicts_with = "core")]
    pub gdb: bool,
    /// Have gdb write a core dump and the backtraces of all threads to that folder if the plugin crashes again.
    #[arg(long)]
    pub core: bool,
}
