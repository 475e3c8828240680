//! The command line.

use clap::{Args, Parser, Subcommand};
use interactive::{By, Drill, Options, Replay};
use planner_host::user_folder;
use scenario::Settings;
use std::path::PathBuf;

/// Console for robots that inspect the floors of oil storage tanks.
///
/// Without a command, opens the console on the demo scenario; if stdout is not a terminal, runs the demo headless.
#[derive(Debug, Parser)]
#[command(name = "tankops", version, arg_required_else_help = false, max_term_width = 100)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub command: Option<Command>,
    #[command(flatten)]
    pub plugins: PluginArgs,
}

/// Where planners are searched for, in addition to the program's folder and `$TANKOPS_PLUGIN_PATH`, and when they are
/// refused.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct PluginArgs {
    /// Additional folder of planner plugins, searched first; repeatable.
    #[arg(long, value_name = "DIR", global = true)]
    pub plugin_dir: Vec<PathBuf>,
    /// Refuse planners unless the system closes off their processes wholly (Linux with Landlock and seccomp).
    #[arg(long, global = true)]
    pub require_sandbox: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Open the console.
    Console(ConsoleArgs),
    /// Run a mission headless to its end.
    Run(RunArgs),
    /// Plan a mission on the drawing without running it.
    Plan(PlanArgs),
    /// Forecast the position accuracy that the stations give, and advise where to place them.
    Accuracy(AccuracyArgs),
    /// Show what becomes of an occupancy map: the floor, its outlines and convex pieces.
    Map(MapArgs),
    /// Create a scenario from a floor drawing (DXF) or a list of columns (CSV).
    Import(ImportArgs),
    /// Create a folder with a planner of your own that builds and flies.
    NewPlanner(NewPlannerArgs),
    /// List available planners, and refused plugins with the reason.
    Planners {
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Validate scenario files, plugins and configuration files.
    Check {
        /// Scenario files (.toml), plugins (.so, .dylib, .dll), and files named config.toml or keys.toml.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// For plugins: check what every planner must do, and fly each of theirs in so many random tanks beside the planners that
        /// are installed.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1000))]
        fly: Option<u64>,
        /// Seed of the first random tank; the others follow.
        #[arg(long, value_name = "SEED", default_value_t = 0, requires = "fly")]
        seed: u64,
        /// Print what came of the flights as JSON, and nothing else on stdout.
        #[arg(long, requires = "fly")]
        json: bool,
    },
    /// Reproduce a table or figure of a paper, with the printed values beside ours.
    Reproduce(ReproduceArgs),
    /// Optimize planner parameters on one set of layouts, and evaluate them on another.
    Tune(TuneArgs),
    /// Play a past run back in the console; no order can be given.
    Replay(ReplayArgs),
    /// Fly many missions, here or on a cluster, and compare what comes of them.
    #[command(subcommand)]
    Campaign(CampaignCommand),
    /// List past runs.
    Runs {
        /// Print JSON.
        #[arg(long)]
        json: bool,
        #[command(flatten)]
        logs: LogsArg,
    },
    /// Recompute a past run and prove that the result matches its journal, byte for byte.
    Verify {
        /// Run folder, or its name in the logs folder.
        run: PathBuf,
        /// Take the planners' answers from the journal instead of asking the planners again, for example if a plugin
        /// is not available. The output states what this proves and what it does not.
        #[arg(long)]
        from_journal: bool,
        #[command(flatten)]
        logs: LogsArg,
    },
    /// Print the events of a past run as JSON lines.
    Events(EventsArgs),
    /// Write a past run as another file: its recording anew, or the readings of its sensors.
    Export(ExportArgs),
    /// Locate a robot by readings that a real system measured: fixes, track, recording and report.
    Locate(LocateArgs),
    /// Show the result of a past run, or of a scan and its re-scans together.
    Report(ReportArgs),
    /// Create a scenario that scans what one or more past runs missed.
    Rescan(RescanArgs),
    /// Print the completions of this command line for a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Print the manual page of tankops or of one of its commands, as roff.
    Man {
        /// A command of tankops.
        command: Option<String>,
    },
    /// Ask a plugin once more what it was asked before it failed, and show each answer.
    ReplayWorker {
        /// Folder `crash-N` in the folder of a run.
        #[arg(value_name = "BUNDLE")]
        bundle: PathBuf,
        /// Run the plugin's process in gdb, without deadlines.
        #[arg(long)]
        gdb: bool,
    },
    /// A planner's own process; started by the console.
    #[command(hide = true)]
    Worker,
}

/// What to do with a campaign.
#[derive(Debug, Subcommand)]
pub(crate) enum CampaignCommand {
    /// Fly a campaign and show what comes of it; what is already flown is kept.
    Run(RunCampaignArgs),
    /// Check a plan and freeze it with its scenarios, so that several machines can work on it.
    Prepare(OutArgs),
    /// Fly blocks of a campaign that was prepared.
    Work(WorkArgs),
    /// Show how far a campaign is; exit code 1 while blocks are missing.
    Status {
        /// Folder of the campaign.
        dir: PathBuf,
    },
    /// Put the blocks together: results.parquet, summary.json and summary.html.
    Merge {
        /// Folder of the campaign.
        dir: PathBuf,
        /// Also when blocks are missing.
        #[arg(long)]
        partial: bool,
    },
    /// Compare a metric of two campaigns, mission by mission.
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

/// What flies a campaign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Engine {
    /// All cores of this machine
    Local,
    /// An array of Slurm jobs, one task for each block
    Slurm,
}

#[derive(Debug, Args)]
pub(crate) struct RunCampaignArgs {
    #[command(flatten)]
    pub out: OutArgs,
    /// What flies the missions.
    #[arg(long, default_value = "local")]
    pub engine: Engine,
    /// Number of missions at once; 0: one per core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub jobs: usize,
    /// Begin no further block after so many core hours, counted over all runs of the campaign: 5ch.
    #[arg(long, value_name = "TIME", value_parser = core_hours)]
    pub budget: Option<f64>,
    /// With --engine slurm: write the script, and print the command that submits it.
    #[arg(long)]
    pub print: bool,
}

#[derive(Debug, Args)]
pub(crate) struct WorkArgs {
    /// Folder of the campaign.
    pub dir: PathBuf,
    /// Fly this block.
    #[arg(long, value_name = "N", conflicts_with_all = ["shard", "pull"])]
    pub block: Option<u64>,
    /// Fly every Nth block, beginning with I, which counts from 0.
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub shard: Option<(u64, u64)>,
    /// Share the blocks with other workers of the same folder: each takes what nobody has.
    #[arg(long)]
    pub pull: bool,
    /// Number of missions at once; 0: one per core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// Folder of a campaign, or its results.parquet.
    pub first: PathBuf,
    /// The other one.
    pub second: PathBuf,
    /// Column to compare.
    #[arg(long, value_name = "METRIC", default_value = "success")]
    pub metric: String,
    /// Column that makes groups, for example planner or scenario.
    #[arg(long, value_name = "COLUMN")]
    pub by: Option<String>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Core hours as seconds of one core.
fn core_hours(text: &str) -> Result<f64, String> {
    let hours =
        text.strip_suffix("ch").and_then(|hours| hours.parse().ok()).filter(|hours: &f64| *hours >= 0.0);
    hours.map(|hours| 3600.0 * hours).ok_or_else(|| "write core hours, as 5ch or 0.5ch".into())
}

fn shard(text: &str) -> Result<(u64, u64), String> {
    let parts = text.split_once('/').and_then(|(at, of)| Some((at.parse().ok()?, of.parse().ok()?)));
    parts.filter(|(at, of)| at < of).ok_or_else(|| "write I/N, as 0/3, 1/3 and 2/3 for three shards".into())
}

#[derive(Debug, Args)]
pub(crate) struct EventsArgs {
    /// Run folder, or its name in the logs folder.
    pub run: PathBuf,
    /// Only events of this kind, by the word in their key `event`; repeatable.
    #[arg(long, value_name = "KIND")]
    pub kind: Vec<String>,
    /// Only from this mission time on, seconds.
    #[arg(long, value_name = "T_S")]
    pub from: Option<f64>,
    /// Only up to this mission time, seconds.
    #[arg(long, value_name = "T_S")]
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
pub(crate) struct LocateArgs {
    /// Readings as CSV, or as MCAP with JSON messages of the same names: `t_s`, `station`, and `range_m`, `arrival_s` (with or
    /// without `emitted_s`) or `tdoa_s`; also in mm, ms and us.
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
    /// Leave bad rows out instead of refusing the file.
    #[arg(long)]
    pub skip_bad_rows: bool,
    /// Write fixes and track as CSV to this file.
    #[arg(short = 'o', long, value_name = "FILE")]
    pub output: Option<PathBuf>,
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
pub(crate) struct NewPlannerArgs {
    /// Id of the planner: a letter, then up to 31 of a-z, 0-9, _ and -.
    pub name: String,
    /// Language of the planner.
    #[arg(long, value_name = "LANG", default_value = "rust")]
    pub lang: Lang,
    /// Folder in which the new folder is created.
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub out: PathBuf,
    /// Folder of the crate `planner-api` (Rust only); default: the one installed with tankops or that it was built with, else
    /// the published one.
    #[arg(long, value_name = "DIR")]
    pub api: Option<PathBuf>,
}

/// A language for planners.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Lang {
    /// Rust, with the crate `planner-api`.
    Rust,
    /// C11, with the header `tankops_planner.h`.
    C,
    /// C++17, with the same header.
    Cpp,
}

#[derive(Debug, Args)]
pub(crate) struct RescanArgs {
    /// Run folders, or their names in the logs folder: a scan and any re-scans of it.
    #[arg(required = true, value_name = "RUN")]
    pub runs: Vec<PathBuf>,
    /// Scenario file to write; must not exist.
    #[arg(short = 'o', long, value_name = "SCENARIO")]
    pub output: PathBuf,
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
    /// Facts for `[inspection]` that were not known before the run, as a TOML file; they take the place of the scenario's.
    #[arg(long, value_name = "FILE", requires = "output")]
    pub inspection: Option<PathBuf>,
    /// Indications of the instrument as CSV: `t_s`, and `left_m`, `ahead_m`, kind, `size_mm`, `depth_mm`, note if there are.
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

/// Where runs are kept.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct LogsArg {
    /// Folder that holds the runs; default: `logs` if there is such a folder here, else `$XDG_STATE_HOME/tankops/logs`.
    #[arg(long, value_name = "DIR")]
    pub logs: Option<PathBuf>,
}

impl LogsArg {
    /// The folder that holds the runs.
    pub(crate) fn folder(&self) -> PathBuf {
        let here = PathBuf::from("logs");
        let of_user = || user_folder("XDG_STATE_HOME", ".local/state").map(|folder| folder.join("logs"));
        let by_default = || if here.is_dir() { here.clone() } else { of_user().unwrap_or(here.clone()) };
        self.logs.clone().unwrap_or_else(by_default)
    }
}

/// What may be changed in a scenario from the command line.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct Changes {
    /// Planner to use instead of the scenario's.
    #[arg(long, value_name = "ID")]
    pub planner: Option<String>,
    /// Set a planner parameter (`k_rep=2`) or any key of the scenario (`mission.swath_m=0.5`).
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Random seed to use instead of the scenario's.
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
}

#[derive(Debug, Default, Args)]
pub(crate) struct ConsoleArgs {
    /// Scenario file; default: the demo.
    pub scenario: Option<PathBuf>,
    #[command(flatten)]
    pub changes: Changes,
    #[command(flatten)]
    pub logs: LogsArg,
    /// Speed of the simulation at first: 0.25 to 64 times real time, or `max`; default: that of config.toml, or 1.
    #[arg(long, value_name = "FACTOR", value_parser = tui::Speed::parse)]
    pub speed: Option<tui::Speed>,
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
    /// Number of colours: none, 16, 256 or true (24 bit); default: that of config.toml, or what the terminal has.
    #[arg(long, value_name = "NUMBER", visible_alias = "color", value_parser = interactive::config::colours)]
    pub colour: Option<tui::Colours>,
    /// Characters of the map and the charts; default: what the terminal's environment promises.
    #[arg(long, value_name = "SET")]
    pub glyphs: Option<GlyphSet>,
    /// Run console commands from a file instead of the keyboard, without a terminal; exit code 1 if a line fails.
    #[arg(long, value_name = "FILE", conflicts_with = "plain")]
    pub script: Option<PathBuf>,
    /// Print what changes as sentences, one a line, and read console commands from stdin: for screen readers and logs.
    #[arg(long)]
    pub plain: bool,
}

impl From<ReplayArgs> for Options {
    fn from(args: ReplayArgs) -> Self {
        let ReplayArgs { run, compare, logs, speed, colour, glyphs, script, plain } = args;
        let console = ConsoleArgs { logs, speed, colour, script, plain, glyphs, ..ConsoleArgs::default() };
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

impl From<&Changes> for Settings {
    fn from(changes: &Changes) -> Self {
        let Changes { planner, set, seed } = changes.clone();
        Self { set, planner, seed }
    }
}

impl From<ConsoleArgs> for Options {
    fn from(args: ConsoleArgs) -> Self {
        let by = match args.script {
            Some(file) => By::Script(file),
            None if args.plain => By::Lines,
            None => By::Keys,
        };
        Self {
            scenario: args.scenario,
            settings: (&args.changes).into(),
            logs: args.logs.folder(),
            speed: args.speed,
            colours: args.colour,
            glyphs: args.glyphs.map(Into::into),
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

#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// Scenario file.
    pub scenario: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
    #[command(flatten)]
    pub logs: LogsArg,
    /// Write neither journal nor recording.
    #[arg(long)]
    pub no_record: bool,
    /// Hold planners to the console's real-time deadlines (for planner authors): a step that is not answered within 60 %
    /// of a tick is late. The result then depends on the machine; the journal can still be verified.
    #[arg(long)]
    pub live_deadlines: bool,
    #[command(flatten)]
    pub shadow: ShadowArgs,
    /// Print the report as JSON on stdout, and nothing else.
    #[arg(long)]
    pub json: bool,
}

/// A planner in shadow of a run.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct ShadowArgs {
    /// Fly this planner in shadow: it plans and commands beside the one that drives, and moves nothing.
    #[arg(long, value_name = "ID")]
    pub shadow: Option<String>,
    /// Set a parameter of the planner in shadow.
    #[arg(long, value_name = "KEY=VALUE", requires = "shadow")]
    pub shadow_set: Vec<String>,
    /// Have the planner in shadow take over so often, in seconds of mission time; the one before it then flies in shadow.
    #[arg(long, value_name = "SECONDS", requires = "shadow")]
    pub promote_every: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct PlanArgs {
    /// Scenario file.
    pub scenario: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
    /// Print the plan as JSON on stdout.
    #[arg(long)]
    pub json: bool,
    /// Draw the tank, obstacles, preset path and planned path to this file.
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Write the plan to this file: .csv (points), .geojson or .dxf.
    #[arg(short = 'o', long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ReproduceArgs {
    /// What to reproduce; default: list everything.
    pub name: Option<String>,
    /// Number of layouts or draws per case; the default depends on the study.
    #[arg(long, value_name = "N")]
    pub layouts: Option<usize>,
    /// Seed of the first layout; the others follow.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub first_seed: u64,
    /// Only cases whose ids start with this (`d1/disk`); repeatable.
    #[arg(long, value_name = "CASE")]
    pub case: Vec<String>,
    /// Only methods whose ids start with this (`rpf/gated`); repeatable.
    #[arg(long, value_name = "METHOD")]
    pub method: Vec<String>,
    /// Number of threads; 0: one per core. Affects times, not results.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// Folder for drawings of every plan, one file per layout and method; created if missing. Only for studies of
    /// whole floors.
    #[arg(long, value_name = "DIR")]
    pub svg: Option<PathBuf>,
    /// Print the rows as a JSON array on stdout.
    #[arg(long)]
    pub json: bool,
    /// List everything that can be reproduced.
    #[arg(long, conflicts_with = "name")]
    pub list: bool,
}

#[derive(Debug, Args)]
pub(crate) struct TuneArgs {
    /// Planner to tune.
    #[arg(long, value_name = "ID")]
    pub planner: String,
    /// Layouts: wang-d1, wang-d2 or wang-d3 (in the disk), wang-d1-square and so on (in the square).
    #[arg(long, value_name = "LAYOUTS")]
    pub on: String,
    /// Parameter to tune; repeatable. Default: every real-valued parameter of the group "Field".
    #[arg(long, value_name = "KEY")]
    pub tune: Vec<String>,
    /// Initial value, or value of a parameter that is not tuned (`reading=gated`).
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Number of layouts to tune on.
    #[arg(long, value_name = "N", default_value_t = 30)]
    pub layouts: usize,
    /// Seed of the first layout to tune on.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub first_seed: u64,
    /// Number of layouts to evaluate on.
    #[arg(long, value_name = "N", default_value_t = 200)]
    pub test_layouts: usize,
    /// Seed of the first layout to evaluate on.
    #[arg(long, value_name = "SEED", default_value_t = 1_000_000)]
    pub test_first_seed: u64,
    /// Generations of the search.
    #[arg(long, value_name = "N", default_value_t = 30)]
    pub generations: usize,
    /// Seed of the search.
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub seed: u64,
    /// Number of threads; 0: one per core. Does not affect the result.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// Print values, losses and rows as JSON on stdout.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct AccuracyArgs {
    /// Scenario file.
    pub scenario: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
    /// Print the forecast of every cell as JSON on stdout.
    #[arg(long)]
    pub json: bool,
    /// Draw the forecast to this file.
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Find the best places on the wall for this many stations, 3 to 32.
    #[arg(long, value_name = "N")]
    pub advise: Option<usize>,
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
}

#[derive(Debug, Args)]
pub(crate) struct ImportArgs {
    /// Drawing (.dxf) with layers SHELL, COLUMNS, PIPES, SUMP and NOGO, or list of columns (.csv) with the fields `x_m`, `y_m`,
    /// `radius_m` or `diameter_m`, and name.
    pub file: PathBuf,
    /// Scenario file to write; must not exist.
    #[arg(short = 'o', long, value_name = "SCENARIO")]
    pub output: PathBuf,
    /// Inner radius of the tank of a list of columns, in metres.
    #[arg(long, value_name = "M", value_parser = length)]
    pub tank_radius: Option<f64>,
    /// Unit of a drawing whose header names none.
    #[arg(long, value_name = "UNIT")]
    pub units: Option<UnitArg>,
    /// Width of pipes that are drawn as lines without one, in metres.
    #[arg(long, value_name = "M", value_parser = length, default_value_t = import::drawing::PIPE_WIDTH_M)]
    pub pipe_width: f64,
    /// Draw the floor to this file.
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
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

fn tolerance(text: &str) -> Result<f64, String> {
    let metres = text.parse().ok().filter(|metres| (0.0..=1.0).contains(metres));
    metres.ok_or_else(|| "write metres from 0 to 1".into())
}

#[cfg(test)]
mod tests;
