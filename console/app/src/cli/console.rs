//! The console and the replay of a past run.

use super::{Changes, LogsArg};
use clap::Args;
use interactive::{By, Drill, Options, Replay};
use std::path::PathBuf;

/// What shows the model: a terminal, a script or plain sentences.
#[derive(Debug, Default, Args)]
pub(crate) struct ScreenArgs {
    /// Number of colours: none, 16, 256 or true (24 bit); default: that of config.toml, or what the terminal has.
    #[arg(long, value_name = "NUMBER", visible_alias = "color", value_parser = interactive::config::colours)]
    pub colour: Option<tui::Colours>,
    /// Run console commands from a file instead of the keyboard, without a terminal; exit code 1 if a line fails.
    #[arg(long, value_name = "FILE", conflicts_with = "plain")]
    pub script: Option<PathBuf>,
    /// Print what changes as sentences, one a line, and read console commands from stdin: for screen readers and logs.
    #[arg(long)]
    pub plain: bool,
    /// Characters of the map and the charts; default: what the terminal's environment promises.
    #[arg(long, value_name = "SET")]
    pub glyphs: Option<GlyphSet>,
}

#[derive(Debug, Default, Args)]
pub(crate) struct ConsoleArgs {
    /// Scenario: a file, or the name of one in the folder `scenarios`; default: the demo.
    pub scenario: Option<PathBuf>,
    #[command(flatten)]
    pub changes: Changes,
    #[command(flatten)]
    pub logs: LogsArg,
    /// Speed of the simulation at first: 0.25 to 64 times real time, or `max`; default: that of config.toml, or 1.
    #[arg(long, value_name = "FACTOR", value_parser = tui::Speed::parse)]
    pub speed: Option<tui::Speed>,
    #[command(flatten)]
    pub screen: ScreenArgs,
    /// Look on at a run that another console has open, or at a past one: its folder, or its name in the logs folder. No order
    /// can be given.
    #[arg(long, value_name = "RUN", conflicts_with_all = ["scenario", "Changes", "speed", "script", "drill"])]
    pub view: Option<PathBuf>,
    /// Make a part of the console fail while the robot moves, to see that the run and the terminal survive it.
    #[arg(long, value_name = "PART", hide = true)]
    pub drill: Option<DrillArg>,
}

#[derive(Debug, Args)]
pub(crate) struct ReplayArgs {
    /// Run folder, its name in the logs folder, or `latest`.
    pub run: PathBuf,
    /// Another run to compare it with.
    #[arg(long, value_name = "RUN")]
    pub compare: Option<PathBuf>,
    #[command(flatten)]
    pub logs: LogsArg,
    /// Speed at first: 0.25 to 64 times real time, or `max`.
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

/// Characters that the terminal's font has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum GlyphSet {
    /// Octants of Unicode 16, dots without gaps: terminal and font must have them
    Octant,
    /// Braille dots.
    Braille,
    /// Half blocks and letters.
    Half,
    /// 7 bit only.
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
            view: args.view,
            replay: None,
            drill: args.drill.map(Into::into),
        }
    }
}

/// A part of the console that fails on purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum DrillArg {
    /// The thread that draws panics.
    PanicScreen,
    /// The thread that flies panics.
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
