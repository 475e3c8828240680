//! Options for running a mission, planning it, and forecasting its position accuracy.

use super::{Changes, LogsArg, VehicleArgs};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// Scenario file, or the name of a scenario in the folder `scenarios`.
    pub scenario: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
    #[command(flatten)]
    pub logs: LogsArg,
    /// Do not write a journal or a recording.
    #[arg(long)]
    pub no_record: bool,
    /// Apply the console's real-time deadlines to planners (for planner authors): a step that is not answered within
    /// 60 % of a tick is late. The result then depends on the machine, but the journal can still be verified.
    #[arg(long)]
    pub live_deadlines: bool,
    #[command(flatten)]
    pub shadow: ShadowArgs,
    #[command(flatten)]
    pub vehicle: VehicleArgs,
    /// Print the report as JSON on stdout, and nothing else.
    #[arg(long)]
    pub json: bool,
}

/// Options for a planner in shadow.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct ShadowArgs {
    /// Run this planner in shadow: it plans and commands alongside the active planner, but moves nothing.
    #[arg(long, value_name = "ID")]
    pub shadow: Option<String>,
    /// Set a parameter of the planner in shadow.
    #[arg(long, value_name = "KEY=VALUE", requires = "shadow")]
    pub shadow_set: Vec<String>,
    /// Swap the active planner and the planner in shadow at this interval, in seconds of mission time.
    #[arg(long, value_name = "SECONDS", requires = "shadow", value_parser = seconds, allow_negative_numbers = true)]
    pub promote_every: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct PlanArgs {
    /// Scenario file, or the name of a scenario in the folder `scenarios`.
    pub scenario: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
    #[command(flatten)]
    pub vehicle: VehicleArgs,
    /// Print the plan as JSON on stdout.
    #[arg(long)]
    pub json: bool,
    /// Draw the tank, obstacles, preset path and planned path to this file.
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Write the plan to this file: .csv (points), .geojson or .dxf.
    #[arg(short = 'o', long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Overwrite existing files.
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct AccuracyArgs {
    /// Scenario file, or the name of a scenario in the folder `scenarios`.
    pub scenario: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
    /// Print the forecast for every cell as JSON on stdout.
    #[arg(long)]
    pub json: bool,
    /// Draw the forecast to this file.
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Overwrite existing files.
    #[arg(long, requires = "svg")]
    pub force: bool,
    /// Find the best positions on the wall for this many stations, 3 to 32.
    #[arg(long, value_name = "N")]
    pub advise: Option<usize>,
    /// Plan the mission, and judge the session of fixes along the planned path.
    #[arg(long)]
    pub plan: bool,
}

fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| seconds.is_finite() && *seconds > 0.0);
    seconds.ok_or_else(|| "write a time in seconds, more than 0".into())
}
