//! Options of the comparison of two surveys.

use super::LogsArg;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct CompareSurveysArgs {
    /// Run folder of the earlier survey, or its name in the logs folder.
    pub first: PathBuf,
    /// Run folder of the later survey, or its name in the logs folder.
    pub second: PathBuf,
    /// Write the comparison to this file: .html, .json or .csv (several files).
    #[arg(short = 'o', long, value_name = "FILE")]
    pub output: PathBuf,
    /// Least thickness that the inspector accepts, in millimetres; from it, the date of the next inspection is
    /// calculated.
    #[arg(long, value_name = "MM", value_parser = thickness, allow_negative_numbers = true)]
    pub minimum_mm: Option<f64>,
    /// TOML file with facts for `[inspection]` of the earlier survey; they override those in its scenario.
    #[arg(long, value_name = "FILE")]
    pub inspection_first: Option<PathBuf>,
    /// TOML file with facts for `[inspection]` of the later survey; they override those in its scenario.
    #[arg(long, value_name = "FILE")]
    pub inspection_second: Option<PathBuf>,
    /// Overwrite existing files, but never a signed report.
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub logs: LogsArg,
}

fn thickness(text: &str) -> Result<f64, String> {
    let mm = text.parse().ok().filter(|mm: &f64| (0.0..=1000.0).contains(mm));
    mm.ok_or_else(|| "write a thickness in millimetres, for example 2.5".into())
}
