//! What is made of past runs.

use super::LogsArg;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct EventsArgs {
    /// Run folder, or its name in the logs folder.
    pub run: PathBuf,
    /// Only events of this kind, by the word in their key `event`; repeatable.
    #[arg(long, value_name = "KIND")]
    pub kind: Vec<String>,
    /// Only from this mission time on, seconds.
    #[arg(long, value_name = "T_S", value_parser = mission_time, allow_negative_numbers = true)]
    pub from: Option<f64>,
    /// Only up to this mission time, seconds.
    #[arg(long, value_name = "T_S", value_parser = mission_time, allow_negative_numbers = true)]
    pub to: Option<f64>,
    #[command(flatten)]
    pub logs: LogsArg,
}

#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    /// Run folder, or its name in the logs folder.
    pub run: PathBuf,
    #[command(flatten)]
    pub to: ExportTo,
    #[command(flatten)]
    pub logs: LogsArg,
}

/// What to write; the files must not exist.
#[derive(Debug, Args)]
#[group(required = true, multiple = true)]
pub(crate) struct ExportTo {
    /// The recording for the rerun viewer, regenerated from the journal.
    #[arg(long, value_name = "FILE")]
    pub rrd: Option<PathBuf>,
    /// The run as messages of ROS 2 (map, coverage, plan, pose, fixes, log) for Foxglove and the MCAP tools.
    #[arg(long, value_name = "FILE")]
    pub mcap: Option<PathBuf>,
    /// The readings of ranges and odometry with the truth as CSV, in the form that `locate` reads; computes the run again.
    #[arg(long, value_name = "FILE")]
    pub ranges: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct RescanArgs {
    /// Run folders, or their names in the logs folder: a scan and any re-scans of it.
    #[arg(required = true, value_name = "RUN")]
    pub runs: Vec<PathBuf>,
    /// Scenario file to write.
    #[arg(short = 'o', long, value_name = "SCENARIO")]
    pub output: PathBuf,
    /// Overwrite existing files.
    #[arg(long)]
    pub force: bool,
    /// Ignore missed areas smaller than this, in square metres; areas close together count as one.
    #[arg(long, value_name = "AREA", default_value_t = review::MIN_AREA_M2)]
    pub min_area_m2: f64,
    #[command(flatten)]
    pub logs: LogsArg,
}

#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// Run folders, or their names in the logs folder; several runs must be of the same floor.
    #[arg(required = true, value_name = "RUN")]
    pub runs: Vec<PathBuf>,
    /// Print JSON.
    #[arg(long, conflicts_with = "output")]
    pub json: bool,
    /// Write the inspection report to this file: .html, .json, .csv (several files), .geojson or .dxf.
    #[arg(short = 'o', long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Facts for `[inspection]` that were not known before the run, as a TOML file; they override the scenario's.
    #[arg(long, value_name = "FILE", requires = "output")]
    pub inspection: Option<PathBuf>,
    /// Indications of the instrument as CSV: `t_s`, and optionally `left_m`, `ahead_m`, kind, `size_mm`, `depth_mm`, note.
    #[arg(long, value_name = "FILE", requires = "output")]
    pub indications: Option<PathBuf>,
    /// Sign the report (.html): needs every item of the gate answered; a signed report is never changed, the next one is
    /// another revision.
    #[arg(long, value_name = "NAME", requires = "output")]
    pub sign: Option<String>,
    /// Write over a file that is there already; never over a signed report.
    #[arg(long, requires = "output", conflicts_with = "sign")]
    pub force: bool,
    #[command(flatten)]
    pub logs: LogsArg,
}

fn mission_time(text: &str) -> Result<f64, String> {
    let t_s = text.parse().ok().filter(|t_s: &f64| *t_s >= 0.0 && t_s.is_finite());
    t_s.ok_or_else(|| "write a time since the start of the mission in seconds, as 0 or 125.5".into())
}
