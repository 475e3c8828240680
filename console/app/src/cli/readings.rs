//! Options of `tankops readings`.

use super::LogsArg;
use clap::Args;
use locate::thickness::{UNITS, Unit, unit};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[allow(clippy::struct_excessive_bools, reason = "each is a separate option")]
pub(crate) struct ReadingsArgs {
    /// Run folder, or its name in the logs folder.
    pub run: PathBuf,
    /// Readings: CSV with the columns `t_s` (or `t_ms`, `t_us`, or `time` with dates), `channel`, and `thickness_mm` or
    /// `depth_mm` (also in um, cm, in and mil), or with a column for each channel (`ch0_mm`, `ch1_mm`, ...), or MCAP with
    /// JSON messages that use the same names. `-` reads standard input.
    pub file: PathBuf,
    /// Unit of the columns whose names state none.
    #[arg(long, value_name = "UNIT", value_parser = unit_arg)]
    pub unit: Option<Unit>,
    /// Seconds to add to the times in the file; the result is the mission time.
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true, conflicts_with = "mark")]
    pub clock_offset: Option<f64>,
    /// A moment by both clocks: the time as in the file, and the mission time in seconds. Give it twice, early and late,
    /// to correct a clock that runs too fast or too slow.
    #[arg(long, value_name = "TIME=MISSION_S", value_parser = mark, allow_hyphen_values = true)]
    pub mark: Vec<(String, f64)>,
    /// Standard deviation, in seconds, of a time in the file; it widens the error of each position along the way.
    #[arg(long, value_name = "S", value_parser = sigma, allow_negative_numbers = true)]
    pub clock_sigma: Option<f64>,
    /// Number of the first channel in the file.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1000))]
    pub first_channel: u16,
    /// The first channel is on the left of the tool, not on the right.
    #[arg(long)]
    pub from_left: bool,
    /// Leave out faulty rows instead of refusing the file, and keep them in readings-refused.csv beside the readings.
    #[arg(long)]
    pub skip_bad_rows: bool,
    /// Replace the readings of an earlier import.
    #[arg(long)]
    pub force: bool,
    /// Print the results as JSON.
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub logs: LogsArg,
}

fn unit_arg(text: &str) -> Result<Unit, String> {
    let names = UNITS.map(|(name, _)| name).join(", ");
    unit(text).ok_or_else(|| format!("write one of {names}"))
}

fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| seconds.is_finite());
    seconds.ok_or_else(|| "write a number of seconds, for example -7200 or 1.5".into())
}

fn sigma(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds| (0.0..=60.0).contains(seconds));
    seconds.ok_or_else(|| "write a number of seconds, 0 to 60".into())
}

fn mark(text: &str) -> Result<(String, f64), String> {
    let parts = text.rsplit_once('=').filter(|(time, _)| !time.trim().is_empty());
    let mark =
        parts.and_then(|(time, mission)| Some((time.trim().to_owned(), seconds(mission.trim()).ok()?)));
    mark.ok_or_else(|| {
        "write the time as in the file, = and the mission time in seconds, for example 07:40:12.250=31.4"
            .into()
    })
}
