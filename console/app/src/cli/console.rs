//! Options of the console and of the replay.

use super::{Changes, LogsArg, VehicleArgs};
use clap::Args;
use interactive::{By, Drill, Options, Replay};
use std::path::PathBuf;

/// Options for how the console is shown: on a terminal, by a script or in plain sentences.
#[derive(Debug, Default, Args)]
pub(crate) struct ScreenArgs {
    /// Number of colours: none, 16, 256 or true (24 bit); default: the setting in config.toml, or what the terminal
    /// supports.
    #[arg(long, value_name = "NUMBER", visible_alias = "color", value_parser = interactive::config::colours)]
    pub colour: Option<tui::Colours>,
    /// Read console commands from a file instead of the keyboard, without a terminal; exit code 1 if a line fails.
    #[arg(long, value_name = "FILE", conflicts_with = "plain")]
    pub script: Option<PathBuf>,
    /// Print changes as sentences, one per line, and read console commands from stdin: for screen readers and logs.
    #[arg(long)]
    pub plain: bool,
    /// Character set of the map and the charts; default: chosen from the terminal's environment variables.
    #[arg(long, value_name = "SET")]
    pub glyphs: Option<GlyphSet>,
}

#[derive(Debug, Default, Args)]
pub(crate) struct ConsoleArgs {
    /// Scenario file, or the name of a scenario in the folder `scenarios`; default: the demo.
    pub scenario: Option<PathBuf>,
    #[command(flatten)]
    pub changes: Changes,
    #[command(flatten)]
    pub logs: LogsArg,
    /// Initial speed of the simulation: 0.25 to 64 times real time, or `max`; default: the setting in config.toml, or
    /// 1.
    #[arg(long, value_name = "FACTOR", value_parser = tui::Speed::parse)]
    pub speed: Option<tui::Speed>,
    #[command(flatten)]
    pub screen: ScreenArgs,
    #[command(flatten)]
    pub vehicle: VehicleArgs,
    /// Watch a run that is open in another console, or view a past run, given by its folder or its name in the logs
    /// folder. No orders can be given.
    #[arg(long, value_name = "RUN", conflicts_with_all = ["scenario", "Changes", "speed", "script", "drill", "vehicle"])]
    pub view: Option<PathBuf>,
    /// Make a part of the console fail while the robot moves, to test that the run and the terminal survive.
    #[arg(long, value_name = "PART", hide = true)]
    pub drill: Option<DrillArg>,
}

#[derive(Debug, Args)]
pub(crate) struct ReplayArgs {
    /// Run folder, its name in the logs folder, or `latest`.
    pub run: PathBuf,
    /// Second run to compare with the first.
    #[arg(long, value_name = "RUN")]
    pub compare: Option<PathBuf>,
    #[command(flatten)]
    pub logs: LogsArg,
    /// Initial speed: 0.25 to 64 times real time, or `max`.
    #[arg(long, value_name = "FACTOR", value_parser = tui::Speed::parse)]
    pub speed: Option<tui::Speed>,
    #[command(flatten)]
    pub screen: ScreenArgs,
}

impl From<ReplayArgs> for Options {
    fn from(args: ReplayArgs) -> Self {
        let ReplayArgs { run, compare, logs, speed, screen } = args;
        let console = ConsoleArgs { logs, speed, screen, ..ConsoleArgs::default() };
        Self { replay: Some(Replay { run, with: compare }), ..console.into() }
    }
}

/// A character set for the map and the charts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum GlyphSet {
    /// Unicode 16 octants: dots without gaps; the terminal and its font must support them
    Octant,
    /// Braille dots.
    Braille,
    /// Half blocks and letters.
    Half,
    /// 7-bit ASCII only.
    Ascii,
}

impl From<GlyphSet> for tui::Glyphs {
    fn from(set: GlyphSet) -> Self {
        match set {
            GlyphSet::Octant => Self::Octant,
            GlyphSet::Braille => Self::Braille,
            GlyphSet::Half => Self::Half,
            GlyphSet::Ascii => Self::Ascii,
        }
    }
}

impl From<ConsoleArgs> for Options {
    fn from(args: ConsoleArgs) -> Self {
        let by = match args.screen.script {
            Some(file) => By::Script(file),
            None if args.screen.plain => By::Lines,
            None => By::Keys,
        };
        Self {
            scenario: args.scenario,
            settings: (&args.changes).into(),
            logs: args.logs.folder(),
            speed: args.speed,
            colours: args.screen.colour,
            glyphs: args.screen.glyphs.map(Into::into),
            by,
            vehicle: args.vehicle.wanted(),
            view: args.view,
            replay: None,
            drill: args.drill.map(Into::into),
        }
    }
}

/// The part of the console to fail on purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum DrillArg {
    /// The drawing thread panics.
    PanicScreen,
    /// The engine thread panics.
    PanicEngine,
}

impl From<DrillArg> for Drill {
    fn from(arg: DrillArg) -> Self {
        match arg {
            DrillArg::PanicScreen => Self::PanicScreen,
            DrillArg::PanicEngine => Self::PanicEngine,
        }
    }
}
