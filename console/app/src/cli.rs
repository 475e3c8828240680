//! The command line.

mod author;
mod campaign;
mod changes;
mod console;
mod files;
mod flight;
mod logs;
mod past;

pub(crate) use author::{Lang, NewPlannerArgs, ReplayWorkerArgs};
pub(crate) use campaign::{CampaignCommand, CompareArgs, Engine, OutArgs, RunCampaignArgs, WorkArgs};
pub(crate) use changes::Changes;
pub(crate) use console::{ConsoleArgs, ReplayArgs};
pub(crate) use files::{FindArg, ImportArgs, LocateArgs, MapArgs};
pub(crate) use flight::{AccuracyArgs, PlanArgs, RunArgs, ShadowArgs};
pub(crate) use logs::LogsArg;
pub(crate) use past::{EventsArgs, ExportArgs, ReportArgs, RescanArgs};

use clap::{Parser, Subcommand};
use command::arguments::{PluginArgs, ReproduceArgs, TuneArgs};
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
    /// Show how an occupancy map is read: the floor, its outlines and convex pieces.
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
        /// For plugins: check what every planner must do, and fly each of their planners in N random tanks beside those that
        /// are installed.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1000))]
        fly: Option<u64>,
        /// Seed of the first random tank; the others follow.
        #[arg(long, value_name = "SEED", default_value_t = 0, requires = "fly")]
        seed: u64,
        /// Print what came of the flights as JSON, and nothing else on stdout.
        #[arg(long, requires = "fly")]
        json: bool,
        /// Write the tanks in which a planner did not complete its mission into this folder, as scenarios to be flown again.
        #[arg(long, value_name = "DIR", requires = "fly")]
        keep: Option<PathBuf>,
    },
    /// Reproduce a table or figure of a paper, with the printed values beside ours.
    Reproduce(ReproduceArgs),
    /// Optimize planner parameters on one set of layouts, and evaluate them on another.
    Tune(TuneArgs),
    /// Play a past run back in the console; read-only.
    Replay(ReplayArgs),
    /// Fly many missions, here or on a cluster, and compare the results.
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
    /// Close a run that was killed: record the SHA-256 of its files, so that it can be part of a signed report.
    Recover {
        /// Run folder, or its name in the logs folder.
        run: PathBuf,
        /// Who closes it; the report says so.
        #[arg(long, value_name = "NAME", value_parser = person)]
        by: String,
        #[command(flatten)]
        logs: LogsArg,
    },
    /// Print the events of a past run as JSON lines.
    Events(EventsArgs),
    /// Write a past run as another file: its recording, regenerated, or the readings of its sensors.
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
    ReplayWorker(ReplayWorkerArgs),
    /// A planner's own process; started by the console.
    #[command(hide = true)]
    Worker,
    /// Gives the terminal to this process's group; started by a console that has lost it.
    #[command(hide = true)]
    TakeTerminal,
}

fn person(text: &str) -> Result<String, String> {
    let is_name = !account::says_nothing(text) && foreign::unplain(text).is_none();
    let name = is_name.then(|| text.trim().to_owned());
    name.ok_or_else(|| "name the person who answers for it".into())
}

#[cfg(test)]
mod tests;
