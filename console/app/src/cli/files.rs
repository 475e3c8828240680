//! Files of other programs: maps, drawings, readings.

use super::{Changes, LogsArg};
use clap::Args;
use import::drawing::Role;
use std::path::PathBuf;

#[derive(Debug, Args)]
#[allow(clippy::struct_excessive_bools, reason = "each is an option of its own")]
pub(crate) struct LocateArgs {
    /// Readings as CSV, or as MCAP with JSON messages of the same names: `t_s`, `station`, and `range_m`, `arrival_s` (with or
    /// without `emitted_s`) or `tdoa_s`; also in mm, ms and us. `-` reads standard input.
    pub readings: PathBuf,
    /// Scenario with tank, stations, start and noise.
    #[arg(long, value_name = "FILE")]
    pub scenario: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
    /// Speed of sound in metres per second, for arrival times.
    #[arg(long, value_name = "M_PER_S", value_parser = sound_speed)]
    pub sound_speed: Option<f64>,
    /// Find out from the readings themselves; repeatable.
    #[arg(long, value_name = "WHAT")]
    pub find: Vec<FindArg>,
    /// When the tool was on, as CSV with `from_s` and `to_s` by the clock of the readings, if they have no column `tool_on`.
    #[arg(long, value_name = "FILE")]
    pub tool_on: Option<PathBuf>,
    /// Skip bad rows instead of refusing the file.
    #[arg(long)]
    pub skip_bad_rows: bool,
    /// Write fixes and track as CSV to this file.
    #[arg(short = 'o', long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Overwrite existing files.
    #[arg(long, requires = "output")]
    pub force: bool,
    /// Write neither journal nor recording.
    #[arg(long)]
    pub no_record: bool,
    /// Print the figures as JSON.
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub logs: LogsArg,
}

/// What readings can reveal besides positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum FindArg {
    /// The speed of sound; four stations at a time.
    SoundSpeed,
    /// The offset between the clocks of robot and stations; four stations at a time, five for both.
    ClockOffset,
}

#[derive(Debug, Args)]
pub(crate) struct MapArgs {
    /// YAML file of the map, as `map` in `[tank]` of a scenario names it.
    pub map: PathBuf,
    /// Keep the floor that holds this place, in metres; default: the largest.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    pub start: Option<[f64; 2]>,
    /// Floor that may become solid where that spares corners of the outlines, as its distance in metres from what is solid;
    /// default: half a cell. A scenario sets it by `map_tolerance_m`.
    #[arg(long, value_name = "M", value_parser = tolerance)]
    pub simplify: Option<f64>,
    /// Draw wall and pieces to this file.
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Overwrite existing files.
    #[arg(long, requires = "svg")]
    pub force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ImportArgs {
    /// Drawing (.dxf) with layers SHELL, COLUMNS, PIPES, SUMP, NOGO and PLATES, or list of columns (.csv) with the fields `x_m`, `y_m`,
    /// `radius_m` or `diameter_m` (also in mm, cm, in, ft), and name; `-` reads either from the standard input.
    pub file: PathBuf,
    /// Scenario file to write.
    #[arg(short = 'o', long, value_name = "SCENARIO")]
    pub output: PathBuf,
    /// Inner radius of the tank of a list of columns, in metres.
    #[arg(long, value_name = "M", value_parser = length)]
    pub tank_radius: Option<f64>,
    /// Unit of the drawing; required if its header names none; overrides the header.
    #[arg(long, value_name = "UNIT")]
    pub units: Option<UnitArg>,
    /// What a layer of the drawing holds: SHELL, COLUMNS, PIPES, SUMP, NOGO, PLATES or IGNORE, as in COLUMNS=Posts; repeatable. A
    /// layer named for SHELL and COLUMNS holds the shell and what stands within.
    #[arg(long, value_name = "WHAT=LAYER", value_parser = layer)]
    pub layer: Vec<(Role, String)>,
    /// Width of pipes that are drawn as lines without one, in metres.
    #[arg(long, value_name = "M", value_parser = length, default_value_t = import::drawing::PIPE_WIDTH_M)]
    pub pipe_width: f64,
    /// Draw the floor to this file.
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Overwrite existing files.
    #[arg(long)]
    pub force: bool,
}

/// A unit of length of drawings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum UnitArg {
    /// Millimetres.
    Mm,
    /// Centimetres.
    Cm,
    /// Metres.
    M,
    /// Inches.
    In,
    /// Feet.
    Ft,
}

impl From<UnitArg> for f64 {
    fn from(unit: UnitArg) -> Self {
        match unit {
            UnitArg::Mm => 1e-3,
            UnitArg::Cm => 1e-2,
            UnitArg::M => 1.0,
            UnitArg::In => 0.0254,
            UnitArg::Ft => 0.3048,
        }
    }
}

fn sound_speed(text: &str) -> Result<f64, String> {
    let speed = text.parse().ok().filter(|speed| (50.0..=10_000.0).contains(speed));
    speed.ok_or_else(|| "write metres per second from 50 to 10000".into())
}

fn length(text: &str) -> Result<f64, String> {
    let metres = text.parse().ok().filter(|metres: &f64| *metres > 0.0 && *metres <= 1000.0);
    metres.ok_or_else(|| "write metres, more than 0 and at most 1000".into())
}

fn place(text: &str) -> Result<[f64; 2], String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    let place = <[f64; 2]>::try_from(numbers).ok().filter(|place| place.iter().all(|v| v.is_finite()));
    place.ok_or_else(|| "write two numbers with a comma, as 1.5,-2".into())
}

fn layer(text: &str) -> Result<(Role, String), String> {
    let (what, name) = text.split_once('=').unwrap_or((text, ""));
    let role = Role::named(what.trim()).filter(|_| !name.trim().is_empty());
    role.map(|role| (role, name.trim().to_owned())).ok_or_else(|| {
        "write SHELL, COLUMNS, PIPES, SUMP, NOGO, PLATES or IGNORE, =, and the layer's name, as in COLUMNS=Posts"
            .into()
    })
}

fn tolerance(text: &str) -> Result<f64, String> {
    let metres = text.parse().ok().filter(|metres| (0.0..=1.0).contains(metres));
    metres.ok_or_else(|| "write metres from 0 to 1".into())
}
