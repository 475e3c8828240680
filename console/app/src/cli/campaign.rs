//! Campaigns of many missions.

use clap::{Args, Subcommand};
use std::path::PathBuf;

/// A subcommand of `campaign`.
#[derive(Debug, Subcommand)]
pub(crate) enum CampaignCommand {
    /// Run a campaign and show the results; missions that are already complete are not repeated.
    Run(RunCampaignArgs),
    /// Check a plan and freeze it with its scenarios, so that several machines can work on it.
    Prepare(OutArgs),
    /// Run blocks of a prepared campaign.
    Work(WorkArgs),
    /// Show the progress of a campaign; exit code 1 while blocks are missing.
    Status {
        /// Folder of the campaign.
        dir: PathBuf,
    },
    /// Combine the blocks into results.parquet, summary.json and summary.html.
    Merge {
        /// Folder of the campaign.
        dir: PathBuf,
        /// Merge even if blocks are missing.
        #[arg(long)]
        partial: bool,
    },
    /// Compare one metric between two campaigns, mission by mission.
    Compare(CompareArgs),
}

#[derive(Debug, Args)]
pub(crate) struct OutArgs {
    /// Plan of the campaign (TOML).
    pub plan: PathBuf,
    /// Folder of the campaign; default: campaigns/NAME.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// The place where a campaign runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Engine {
    /// All cores of this machine
    Local,
    /// A Slurm job array, one task per block
    Slurm,
}

#[derive(Debug, Args)]
pub(crate) struct RunCampaignArgs {
    #[command(flatten)]
    pub out: OutArgs,
    /// Where to run the missions.
    #[arg(long, default_value = "local")]
    pub engine: Engine,
    /// Number of missions to run in parallel; 0: one per core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub jobs: usize,
    /// Start no further block after this many core hours, for example 5ch, counted over all runs of the campaign.
    #[arg(long, value_name = "TIME", value_parser = core_hours)]
    pub budget: Option<f64>,
    /// With --engine slurm: write the script, and print the command that submits it instead of running that command.
    #[arg(long)]
    pub print: bool,
}

#[derive(Debug, Args)]
pub(crate) struct WorkArgs {
    /// Folder of the campaign.
    pub dir: PathBuf,
    /// Run this block only.
    #[arg(long, value_name = "N", conflicts_with_all = ["shard", "pull"])]
    pub block: Option<u64>,
    /// Run every Nth block, beginning with block I (counted from 0).
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub shard: Option<(u64, u64)>,
    /// Share the blocks with other workers in the same folder: each worker takes a block that no other worker holds.
    #[arg(long)]
    pub pull: bool,
    /// Number of missions to run in parallel; 0: one per core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// Folder of a campaign, or its results.parquet.
    pub first: PathBuf,
    /// Folder of the campaign to compare with, or its results.parquet.
    pub second: PathBuf,
    /// Column to compare.
    #[arg(long, value_name = "METRIC", default_value = "success")]
    pub metric: String,
    /// Column to group by, for example planner or scenario.
    #[arg(long, value_name = "COLUMN")]
    pub by: Option<String>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Parses core hours; returns core seconds.
fn core_hours(text: &str) -> Result<f64, String> {
    let hours =
        text.strip_suffix("ch").and_then(|hours| hours.parse().ok()).filter(|hours: &f64| *hours >= 0.0);
    hours.map(|hours| 3600.0 * hours).ok_or_else(|| "write core hours, for example 5ch or 0.5ch".into())
}

fn shard(text: &str) -> Result<(u64, u64), String> {
    let parts = text.split_once('/').and_then(|(at, of)| Some((at.parse().ok()?, of.parse().ok()?)));
    parts
        .filter(|(at, of)| at < of)
        .ok_or_else(|| "write I/N, for example 0/3, 1/3 and 2/3 for three shards".into())
}
