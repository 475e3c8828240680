//! The command line.

use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Console for robots that inspect the floors of oil storage tanks.
///
/// Without a command: the console on the demo scenario, or, with no terminal on stdout, the demo flown headless.
#[derive(Debug, Parser)]
#[command(name = "tankops", version, arg_required_else_help = false, max_term_width = 100)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub command: Option<Command>,
    #[command(flatten)]
    pub plugins: PluginArgs,
}

/// Where planners are looked for, besides beside the program and in `$TANKOPS_PLUGIN_PATH`.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct PluginArgs {
    /// Another folder with planner plugins; may be given several times, searched first.
    #[arg(long, value_name = "DIR", global = true)]
    pub plugin_dir: Vec<PathBuf>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Open the console.
    Console(ConsoleArgs),
    /// Fly a mission headless to its end.
    Run(RunArgs),
    /// Plan on the known map without flying.
    Plan(PlanArgs),
    /// Forecast how well the stations will locate the robot, and advise where they should stand.
    Accuracy(AccuracyArgs),
    /// List the planners found, and the plugins refused with the reason.
    Planners {
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Validate scenario files and plugins.
    Check {
        /// Scenario files (.toml) and plugins (.so, .dylib, .dll).
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
    /// Reproduce a table or figure of a paper, our values beside the printed ones.
    Reproduce(ReproduceArgs),
    /// Search for better parameters of a planner on one set of layouts, and evaluate them on another.
    Tune(TuneArgs),
    /// List past runs.
    Runs {
        /// Print JSON.
        #[arg(long)]
        json: bool,
        #[command(flatten)]
        logs: LogsArg,
    },
    /// Compute a past run again and prove that its journal is equal.
    Verify {
        /// Folder of the run, or its name within the logs.
        run: PathBuf,
        /// Take the planners' answers from the journal instead of asking the planners again: for a plugin that is not
        /// available. The output states what this proves and what it does not.
        #[arg(long)]
        from_journal: bool,
        #[command(flatten)]
        logs: LogsArg,
    },
    /// Regenerate the recording of a past run from its journal.
    Export {
        /// Folder of the run, or its name within the logs.
        run: PathBuf,
        /// File to write; must not exist.
        #[arg(long, value_name = "FILE")]
        rrd: PathBuf,
        #[command(flatten)]
        logs: LogsArg,
    },
    /// Show the result of a past run, or of a scan and its re-scans together.
    Report {
        /// Folders of runs, or their names within the logs; several must be of one floor.
        #[arg(required = true, value_name = "RUN")]
        runs: Vec<PathBuf>,
        /// Print JSON.
        #[arg(long)]
        json: bool,
        /// Write into this file instead of to stdout.
        #[arg(short = 'o', long, value_name = "FILE")]
        output: Option<PathBuf>,
        #[command(flatten)]
        logs: LogsArg,
    },
    /// Make a scenario that scans what a past run, or several together, missed, with a plan of its own.
    Rescan(RescanArgs),
    /// A planner's own process; started by the console.
    #[command(hide = true)]
    Worker,
}

#[derive(Debug, Args)]
pub(crate) struct RescanArgs {
    /// Folders of runs, or their names within the logs: a scan and the re-scans that were flown already.
    #[arg(required = true, value_name = "RUN")]
    pub runs: Vec<PathBuf>,
    /// Scenario file to write; must not exist.
    #[arg(short = 'o', long, value_name = "SCENARIO")]
    pub output: PathBuf,
    /// Missed areas smaller than this, with what lies closely beside them, are left, in square metres.
    #[arg(long, value_name = "AREA", default_value_t = 0.05)]
    pub least_m2: f64,
    #[command(flatten)]
    pub logs: LogsArg,
}

/// Where runs are kept.
#[derive(Debug, Clone, Args)]
pub(crate) struct LogsArg {
    /// Folder that holds the runs.
    #[arg(long, value_name = "DIR", default_value = "logs")]
    pub logs: PathBuf,
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
    /// Start of every random choice, instead of the scenario's.
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
}

#[derive(Debug, Args)]
pub(crate) struct ConsoleArgs {
    /// Scenario file; the demo if none is given.
    pub scenario: Option<PathBuf>,
    #[command(flatten)]
    pub changes: Changes,
    #[command(flatten)]
    pub logs: LogsArg,
    /// Make a part of the console fail while the robot moves, to see that the run and the terminal survive it.
    #[arg(long, value_name = "PART", hide = true)]
    pub drill: Option<Drill>,
}

/// A part of the console that fails on purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Drill {
    /// The thread that draws panics.
    PanicScreen,
    /// The thread that flies panics.
    PanicEngine,
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
    /// Wait for planners no longer than the console does at the pace of the clock, for authors of planners: a step that is
    /// not answered within 60 % of a tick is late. The result then depends on the machine; the journal still verifies.
    #[arg(long)]
    pub live_deadlines: bool,
    /// Print the report as JSON on stdout, and nothing else.
    #[arg(long)]
    pub json: bool,
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
    /// Draw tank, obstacles, preset and planned path into this file.
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ReproduceArgs {
    /// What to reproduce; without it, everything there is is listed.
    pub name: Option<String>,
    /// Number of layouts or draws of each case; each study has a number of its own.
    #[arg(long, value_name = "N")]
    pub layouts: Option<usize>,
    /// Seed of the first layout; the others follow.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub first_seed: u64,
    /// Only cases whose ids begin so (`d1/disk`); may be given several times.
    #[arg(long, value_name = "CASE")]
    pub case: Vec<String>,
    /// Only methods whose ids begin so (`rpf/gated`); may be given several times.
    #[arg(long, value_name = "METHOD")]
    pub method: Vec<String>,
    /// Threads to work with; 0 is one for each core. Figures do not depend on it, times do.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// Folder to draw every plan into, one file for each layout and method; it is made if it does not exist. Only
    /// for studies of whole floors.
    #[arg(long, value_name = "DIR")]
    pub svg: Option<PathBuf>,
    /// Print an array of rows as JSON on stdout.
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
    /// Layouts: wang-d1, wang-d2, wang-d3, drawn in the disk, or wang-d1-square and so on.
    #[arg(long, value_name = "LAYOUTS")]
    pub on: String,
    /// Parameter to tune; may be given several times. Without it, every real number of the group "Field".
    #[arg(long, value_name = "KEY")]
    pub tune: Vec<String>,
    /// Value to start from, or of a parameter that is not tuned (`reading=gated`).
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
    /// Threads to work with; 0 is one for each core. The result does not depend on it.
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
    /// Draw the forecast into this file.
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Find the best places on the wall for so many stations, 3 to 32.
    #[arg(long, value_name = "N")]
    pub advise: Option<usize>,
}

#[cfg(test)]
mod tests;
