//! Options of the commands for past runs.

use super::LogsArg;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct EventsArgs {
    /// Run folder, or its name in the logs folder.
    pub run: PathBuf,
    /// Print only events of this kind (the value of the key `event`); repeatable.
    #[arg(long, value_name = "KIND")]
    pub kind: Vec<String>,
    /// Print only events at or after this mission time, in seconds.
    #[arg(long, value_name = "T_S", value_parser = mission_time, allow_negative_numbers = true)]
    pub from: Option<f64>,
    /// Print only events at or before this mission time, in seconds.
    #[arg(long, value_name = "T_S", value_parser = mission_time, allow_negative_numbers = true)]
    pub to: Option<f64>,
    /// Continue with the events of a run in progress, until it ends.
    #[arg(long)]
    pub follow: bool,
    /// Send the events to each client of this TCP address instead of printing them, for example 127.0.0.1:4720; port 0
    /// is any free port. Each client receives the events from the first one on. Implies --follow.
    #[arg(long, value_name = "HOST:PORT")]
    pub socket: Option<String>,
    /// Allow an address on the network with --socket; the wire is not protected.
    #[arg(long, requires = "socket")]
    pub socket_network: bool,
    /// Print a line with the event `heartbeat` if no event follows within this time, in seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0, value_parser = heartbeat)]
    pub heartbeat: f64,
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

/// The files to write; they must not exist yet.
#[derive(Debug, Args)]
#[group(required = true, multiple = true)]
pub(crate) struct ExportTo {
    /// Write the recording for the rerun viewer, regenerated from the journal.
    #[arg(long, value_name = "FILE")]
    pub rrd: Option<PathBuf>,
    /// Write the run as ROS 2 messages (map, coverage, plan, pose, fixes, log) for Foxglove and the MCAP tools.
    #[arg(long, value_name = "FILE")]
    pub mcap: Option<PathBuf>,
    /// Write range and odometry readings, with the true positions, as CSV in the format that `tankops locate` reads;
    /// recomputes the run.
    #[arg(long, value_name = "FILE")]
    pub ranges: Option<PathBuf>,
    /// Write the readings of the instrument as Parquet, computed from the journal.
    #[arg(long, value_name = "FILE")]
    pub readings: Option<PathBuf>,
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
    /// Ignore missed areas smaller than this, in square metres; areas that are close together count as one area.
    #[arg(long, value_name = "AREA", default_value_t = review::MIN_AREA_M2)]
    pub min_area_m2: f64,
    #[command(flatten)]
    pub logs: LogsArg,
}

#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("written").multiple(true).args(["output", "package"])))]
pub(crate) struct ReportArgs {
    /// Run folders, or their names in the logs folder; all runs must be on the same floor.
    #[arg(required = true, value_name = "RUN")]
    pub runs: Vec<PathBuf>,
    /// Print JSON.
    #[arg(long, conflicts_with = "written")]
    pub json: bool,
    /// Write the inspection report to this file: .html, .json, .csv (several files), .geojson or .dxf.
    #[arg(short = 'o', long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Write the report with everything that belongs to it (page, tables, drawings, readings, notes, signatures, list of
    /// digests) to this file (.zip); `tankops verify FILE.zip` checks it without the runs.
    #[arg(long, value_name = "FILE")]
    pub package: Option<PathBuf>,
    /// TOML file with facts for `[inspection]` that were not known before the run; they override those in the scenario.
    #[arg(long, value_name = "FILE", requires = "written")]
    pub inspection: Option<PathBuf>,
    /// CSV file with the instrument's indications: `t_s`, and optionally `left_m`, `ahead_m`, `kind`, `size_mm`,
    /// `depth_mm`, `note`.
    #[arg(long, value_name = "FILE", requires = "written")]
    pub indications: Option<PathBuf>,
    /// Sign the report (.html): every item of the gate must be answered. A signed report never changes; the next report
    /// is a new revision.
    #[arg(long, value_name = "NAME", requires = "output", value_parser = super::person)]
    pub sign: Option<String>,
    /// Overwrite existing files, but never a signed report.
    #[arg(long, requires = "written", conflicts_with = "sign")]
    pub force: bool,
    #[command(flatten)]
    pub logs: LogsArg,
}

fn mission_time(text: &str) -> Result<f64, String> {
    let t_s = text.parse().ok().filter(|t_s: &f64| *t_s >= 0.0 && t_s.is_finite());
    t_s.ok_or_else(|| "write a mission time in seconds, for example 0 or 125.5".into())
}

fn heartbeat(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds| (0.1..=3600.0).contains(seconds));
    seconds.ok_or_else(|| "write a number of seconds from 0.1 to 3600".into())
}
