//! Options for files of other programs: maps, drawings and readings.

use super::{Changes, LogsArg};
use clap::Args;
use import::drawing::Role;
use std::path::PathBuf;

#[derive(Debug, Args)]
#[allow(clippy::struct_excessive_bools, reason = "each is a separate option")]
pub(crate) struct LocateArgs {
    /// Readings: CSV with the columns `t_s`, `station`, and `range_m`, `arrival_s` (with or without `emitted_s`) or
    /// `tdoa_s` (also in mm, ms and us), or MCAP with JSON messages that use the same names. `-` reads standard input.
    pub readings: PathBuf,
    /// Scenario that provides the tank, stations, start and noise.
    #[arg(long, value_name = "FILE")]
    pub scenario: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
    /// Speed of sound in metres per second; required for arrival times.
    #[arg(long, value_name = "M_PER_S", value_parser = sound_speed)]
    pub sound_speed: Option<f64>,
    /// Also estimate this quantity from the readings; repeatable.
    #[arg(long, value_name = "WHAT")]
    pub find: Vec<FindArg>,
    /// CSV file with the periods in which the tool was on (`from_s`, `to_s`, by the clock of the readings), for
    /// readings without a column `tool_on`.
    #[arg(long, value_name = "FILE")]
    pub tool_on: Option<PathBuf>,
    /// Skip bad rows instead of refusing the file.
    #[arg(long)]
    pub skip_bad_rows: bool,
    /// Write the fixes and the track to this CSV file.
    #[arg(short = 'o', long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Overwrite existing files.
    #[arg(long, requires = "output")]
    pub force: bool,
    /// Do not write a journal or a recording.
    #[arg(long)]
    pub no_record: bool,
    /// Print the results as JSON.
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub logs: LogsArg,
}

/// A quantity that can be estimated from the readings in addition to positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum FindArg {
    /// The speed of sound; needs four stations per emission.
    SoundSpeed,
    /// The offset between the clocks of the robot and the stations; needs four stations per emission, or five if the
    /// speed of sound is also estimated.
    ClockOffset,
}

#[derive(Debug, Args)]
pub(crate) struct MapArgs {
    /// YAML file of the map; a scenario names it with the key `map` in its section `[tank]`.
    pub map: PathBuf,
    /// Keep the floor area that contains this point, in metres; default: the largest area.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    pub start: Option<[f64; 2]>,
    /// Largest distance, in metres, by which solid areas may grow into the floor to simplify the outlines; default:
    /// half a cell. The key in a scenario is `map_tolerance_m`.
    #[arg(long, value_name = "M", value_parser = tolerance)]
    pub simplify: Option<f64>,
    /// Draw the wall and the convex pieces to this file.
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Overwrite existing files.
    #[arg(long, requires = "svg")]
    pub force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ImportArgs {
    /// Drawing (.dxf) with layers SHELL, COLUMNS, PIPES, SUMP, NOGO and PLATES, or list of columns (.csv) with the
    /// fields `x_m`, `y_m`, `radius_m` or `diameter_m` (also in mm, cm, in, ft), and optionally `name`; `-` reads
    /// either from standard input.
    pub file: PathBuf,
    /// Scenario file to write.
    #[arg(short = 'o', long, value_name = "SCENARIO")]
    pub output: PathBuf,
    /// Inner radius of the tank, in metres; required for a list of columns.
    #[arg(long, value_name = "M", value_parser = length)]
    pub tank_radius: Option<f64>,
    /// Unit of length of the drawing; overrides the unit in its header, and is required if the header states none.
    #[arg(long, value_name = "UNIT")]
    pub units: Option<UnitArg>,
    /// Assign a layer of the drawing to SHELL, COLUMNS, PIPES, SUMP, NOGO, PLATES or IGNORE, for example COLUMNS=Posts;
    /// repeatable. A layer assigned to both SHELL and COLUMNS contains the shell and the columns inside it.
    #[arg(long, value_name = "WHAT=LAYER", value_parser = layer)]
    pub layer: Vec<(Role, String)>,
    /// Width, in metres, of pipes drawn as lines without a width.
    #[arg(long, value_name = "M", value_parser = length, default_value_t = import::drawing::PIPE_WIDTH_M)]
    pub pipe_width: f64,
    /// Draw the floor to this file.
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Overwrite existing files.
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct MapOfArgs {
    /// Run folder of a survey, or its name in the logs folder; or a log of laser scans of the CARMEN toolkit (.log, .clf)
    /// with corrected poses.
    pub run: PathBuf,
    /// File to write: NAME.yaml for a map of the ROS map server (with its image NAME.pgm beside it), NAME.toml for a
    /// scenario that scans the mapped floor (only of a survey).
    #[arg(short = 'o', long, value_name = "MAP")]
    pub output: PathBuf,
    /// Draw the map of a log, with the obstacles that the tracker has found in its scans, to this file.
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Maximum distance that the scanner of a log can measure, in metres; a ray with a greater distance has no echo.
    #[arg(long, value_name = "M", value_parser = length, default_value_t = 20.0)]
    pub range: f64,
    /// Standard deviation of the distances of a log, in metres.
    #[arg(long, value_name = "M", value_parser = length, default_value_t = 0.03)]
    pub sigma: f64,
    /// Radius of the hull of the robot of a log, in metres; echoes from inside it are ignored.
    #[arg(long, value_name = "M", value_parser = length, default_value_t = 0.2)]
    pub hull: f64,
    /// Overwrite existing files.
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub logs: LogsArg,
}

/// The unit of length of a drawing.
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
    speed.ok_or_else(|| "write a speed in metres per second, 50 to 10000".into())
}

fn length(text: &str) -> Result<f64, String> {
    let metres = text.parse().ok().filter(|metres: &f64| *metres > 0.0 && *metres <= 1000.0);
    metres.ok_or_else(|| "write a length in metres, more than 0 and at most 1000".into())
}

fn place(text: &str) -> Result<[f64; 2], String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    let place = <[f64; 2]>::try_from(numbers).ok().filter(|place| place.iter().all(|v| v.is_finite()));
    place.ok_or_else(|| "write two numbers separated by a comma, for example 1.5,-2".into())
}

fn layer(text: &str) -> Result<(Role, String), String> {
    let (what, name) = text.split_once('=').unwrap_or((text, ""));
    let role = Role::named(what.trim()).filter(|_| !name.trim().is_empty());
    role.map(|role| (role, name.trim().to_owned())).ok_or_else(|| {
        "write SHELL, COLUMNS, PIPES, SUMP, NOGO, PLATES or IGNORE, then = and the name of the layer, for \
         example COLUMNS=Posts"
            .into()
    })
}

fn tolerance(text: &str) -> Result<f64, String> {
    let metres = text.parse().ok().filter(|metres| (0.0..=1.0).contains(metres));
    metres.ok_or_else(|| "write a distance in metres, 0 to 1".into())
}
