//! Studies of papers, and the search for parameters.

use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ReproduceArgs {
    /// What to reproduce; default: list everything.
    pub name: Option<String>,
    /// Number of layouts or draws per case; the default depends on the study.
    #[arg(long, value_name = "N")]
    pub layouts: Option<usize>,
    /// Seed of the first layout; the others follow.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub first_seed: u64,
    /// Only cases whose ids start with this (`d1/disk`); repeatable.
    #[arg(long, value_name = "CASE")]
    pub case: Vec<String>,
    /// Only methods whose ids start with this (`rpf/gated`); repeatable.
    #[arg(long, value_name = "METHOD")]
    pub method: Vec<String>,
    /// Number of threads; 0: one per core. Affects times, not results.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// Folder for drawings of every plan or of its curves, one file per layout and method; created if missing. Studies of
    /// positions have nothing to draw; with --out, only plans that this process makes.
    #[arg(long, value_name = "DIR")]
    pub svg: Option<PathBuf>,
    /// Folder for the answers, created if missing: the same command with the same folder resumes where it was ended, and
    /// several that run at once, on any machines, share the work.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print the rows as a JSON array on stdout.
    #[arg(long)]
    pub json: bool,
    /// Print the rows as CSV on stdout.
    #[arg(long, conflicts_with = "json")]
    pub csv: bool,
    /// List every study, and the account of the papers: each equation, table, figure and claim, what became of it, and the
    /// command that shows it.
    #[arg(long, conflicts_with = "name")]
    pub list: bool,
}

#[derive(Debug, Args)]
pub(crate) struct TuneArgs {
    /// Planner to tune.
    #[arg(long, value_name = "ID")]
    pub planner: String,
    /// Layouts: wang-d1, wang-d2 or wang-d3 (in the disk), wang-d1-square and so on (in the square).
    #[arg(long, value_name = "LAYOUTS")]
    pub on: String,
    /// Parameter to tune; repeatable. Default: every real-valued parameter of the group "Field".
    #[arg(long, value_name = "KEY")]
    pub tune: Vec<String>,
    /// Initial value, or value of a parameter that is not tuned (`reading=gated`).
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
    /// Generations of the search.
    #[arg(long, value_name = "N", default_value_t = 30)]
    pub generations: usize,
    /// Seed of the search.
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub seed: u64,
    /// Number of threads; 0: one per core. Does not affect the result.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// Folder for the answers, created if missing: the same command with the same folder resumes where it was ended, and
    /// several that run at once, on any machines, share the work.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print values, losses and rows as JSON on stdout.
    #[arg(long)]
    pub json: bool,
}
