//! Options that both programs share: plugin folders, and the arguments of studies and searches.

use clap::Args;
use flight::failure::bad_input;
use planner_host::PluginDirs;
use std::path::PathBuf;

/// Additional plugin folders, besides the program's folder and `$TANKOPS_PLUGIN_PATH`, and the sandbox requirement.
#[derive(Debug, Clone, Default, Args)]
pub struct PluginArgs {
    /// Additional folder of planner plugins, searched first; repeatable.
    #[arg(long, value_name = "DIR", global = true)]
    pub plugin_dir: Vec<PathBuf>,
    /// Refuse planners unless the system fully sandboxes their processes (Linux with Landlock and seccomp).
    #[arg(long, global = true)]
    pub require_sandbox: bool,
}

impl PluginArgs {
    /// The plugin folders to search.
    ///
    /// # Errors
    /// A named folder does not exist.
    pub fn dirs(&self) -> anyhow::Result<PluginDirs> {
        if let Some(missing) = self.plugin_dir.iter().find(|dir| !dir.is_dir()) {
            return Err(bad_input(format!("--plugin-dir {}: the folder does not exist", missing.display())));
        }
        Ok(PluginDirs { requires_sandbox: self.require_sandbox, ..PluginDirs::standard(&self.plugin_dir) })
    }
}

/// The arguments of `reproduce`.
#[derive(Debug, Args)]
pub struct ReproduceArgs {
    /// Study to reproduce; default: list all.
    pub name: Option<String>,
    /// Number of layouts or draws per case; the default depends on the study.
    #[arg(long, value_name = "N")]
    pub layouts: Option<usize>,
    /// Seed of the first layout; later layouts use the following seeds.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub first_seed: u64,
    /// Run only cases whose ids start with this prefix (`d1/disk`); repeatable.
    #[arg(long, value_name = "CASE")]
    pub case: Vec<String>,
    /// Run only methods whose ids start with this prefix (`rpf/gated`); repeatable.
    #[arg(long, value_name = "METHOD")]
    pub method: Vec<String>,
    /// Number of threads; 0: one per core. Affects the computing times, not the results.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// Folder for drawings of plans or curves, one file per layout and method; created if missing. Studies of positions
    /// have no drawings. With --out, only plans made by this process are drawn.
    #[arg(long, value_name = "DIR")]
    pub svg: Option<PathBuf>,
    /// Folder for results computed so far; created if missing. Repeating the command with the same folder resumes the
    /// work, and several processes, on any machines, can share it.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print the rows as a JSON array on stdout.
    #[arg(long)]
    pub json: bool,
    /// Print the rows as CSV on stdout.
    #[arg(long, conflicts_with = "json")]
    pub csv: bool,
    /// List every study, and each equation, table, figure and claim of the papers with its outcome and the command that
    /// shows it.
    #[arg(long, conflicts_with = "name")]
    pub list: bool,
}

/// The arguments of `tune`.
#[derive(Debug, Args)]
pub struct TuneArgs {
    /// Planner to tune.
    #[arg(long, value_name = "ID")]
    pub planner: String,
    /// Layouts: wang-d1, wang-d2 or wang-d3 (disk), or wang-d1-square and so on (square).
    #[arg(long, value_name = "LAYOUTS")]
    pub on: String,
    /// Parameter to tune; repeatable. Default: every real-valued parameter of the group "Field".
    #[arg(long, value_name = "KEY")]
    pub tune: Vec<String>,
    /// Initial value of a tuned parameter, or fixed value of a parameter that is not tuned (`reading=gated`).
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Number of layouts to tune on.
    #[arg(long, value_name = "N", default_value_t = 30)]
    pub layouts: usize,
    /// Seed of the first layout to tune on.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub first_seed: u64,
    /// Number of layouts to evaluate on.
    #[arg(long, value_name = "N", default_value_t = 200)]
    pub test_layouts: usize,
    /// Seed of the first layout to evaluate on.
    #[arg(long, value_name = "SEED", default_value_t = 1_000_000)]
    pub test_first_seed: u64,
    /// Number of generations of the search.
    #[arg(long, value_name = "N", default_value_t = 30)]
    pub generations: usize,
    /// Random seed of the search.
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub seed: u64,
    /// Number of threads; 0: one per core. Does not affect the result.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// Folder for results computed so far; created if missing. Repeating the command with the same folder resumes the
    /// work, and several processes, on any machines, can share it.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print values, losses and rows as JSON on stdout.
    #[arg(long)]
    pub json: bool,
}
