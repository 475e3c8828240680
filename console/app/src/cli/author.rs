//! For authors of planners.

use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct NewPlannerArgs {
    /// Id of the planner: a letter, then up to 31 of a-z, 0-9, _ and -.
    pub name: String,
    /// Language of the planner.
    #[arg(long, value_name = "LANG", default_value = "rust")]
    pub lang: Lang,
    /// Folder in which the new folder is created.
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub out: PathBuf,
    /// Folder of the crate `planner-api` (Rust only); default: the one installed with tankops or that it was built with, else
    /// the published one.
    #[arg(long, value_name = "DIR")]
    pub api: Option<PathBuf>,
}

/// A language for planners.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Lang {
    /// Rust, with the crate `planner-api`.
    Rust,
    /// C11, with the header `tankops_planner.h`.
    C,
    /// C++17, with the same header.
    Cpp,
}
