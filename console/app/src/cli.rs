//! The command line.

mod author;
mod campaign;
mod changes;
mod console;
mod files;
mod flight;
mod logs;
mod past;
mod readings;
mod surveys;
mod vehicle;

pub(crate) use author::{Lang, NewPlannerArgs, NewVehicleArgs, ReplayWorkerArgs, VehicleLang};
pub(crate) use campaign::{CampaignCommand, CompareArgs, Engine, OutArgs, RunCampaignArgs, WorkArgs};
pub(crate) use changes::Changes;
pub(crate) use console::{ConsoleArgs, ReplayArgs};
pub(crate) use files::{FindArg, ImportArgs, LocateArgs, MapArgs, MapOfArgs};
pub(crate) use flight::{AccuracyArgs, PlanArgs, RunArgs, ShadowArgs};
pub(crate) use logs::LogsArg;
pub(crate) use past::{EventsArgs, ExportArgs, ReportArgs, RescanArgs};
pub(crate) use readings::ReadingsArgs;
pub(crate) use surveys::CompareSurveysArgs;
pub(crate) use vehicle::{SimulateArgs, TrialArgs, VehicleArgs, VehicleCommand};

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
    /// Offer a vehicle to a console.
    #[command(subcommand)]
    Vehicle(VehicleCommand),
    /// Forecast how accurately the stations will locate the robot, and advise where to place them.
    Accuracy(AccuracyArgs),
    /// Show how an occupancy map is interpreted: the floor, its outlines and convex pieces.
    Map(MapArgs),
    /// Write the map that a survey has made, as a ROS map or as a scenario.
    MapOf(MapOfArgs),
    /// Create a scenario from a floor drawing (DXF) or a list of columns (CSV).
    Import(ImportArgs),
    /// Create a folder for a planner of your own, ready to build and run.
    NewPlanner(NewPlannerArgs),
    /// List the available planners, and any refused plugins with the reasons.
    Planners {
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
    /// Create a folder for an adapter to a vehicle of your own, ready to run.
    NewVehicle(NewVehicleArgs),
    /// Validate scenario files, plugins and configuration files, or try a vehicle.
    Check {
        /// Scenario files (.toml), plugins (.so, .dylib, .dll), and files named config.toml or keys.toml.
        #[arg(required_unless_present = "vehicle", value_name = "FILE")]
        files: Vec<PathBuf>,
        /// For plugins: check the planner contract, and compare each planner with the installed ones in N random tanks.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1000), group = "tried")]
        fly: Option<u64>,
        /// Seed of the first random tank; later tanks use the following seeds.
        #[arg(long, value_name = "SEED", default_value_t = 0, requires = "fly")]
        seed: u64,
        /// Print the results of the trial runs or of the trial of a vehicle as JSON, and nothing else on stdout.
        #[arg(long, requires = "tried")]
        json: bool,
        /// Save to this folder each tank in which a planner did not complete its mission, as a scenario that can be run
        /// again.
        #[arg(long, value_name = "DIR", requires = "fly")]
        keep: Option<PathBuf>,
        #[command(flatten)]
        trial: TrialArgs,
    },
    /// Reproduce a table or figure from a paper; show the printed values beside ours.
    Reproduce(ReproduceArgs),
    /// Optimize planner parameters on one set of layouts, and evaluate them on another set.
    Tune(TuneArgs),
    /// Play back a past run in the console; read-only.
    Replay(ReplayArgs),
    /// Run many missions, on this machine or a cluster, and compare the results.
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
        /// Run folder, or its name in the logs folder; or a package (.zip) of `tankops report --package`.
        run: PathBuf,
        /// Take the planners' answers from the journal instead of asking the planners again, for example if a plugin is
        /// no longer available. The output states what this proves and what it does not.
        #[arg(long)]
        from_journal: bool,
        #[command(flatten)]
        logs: LogsArg,
    },
    /// Close a run that was killed or could not be closed: complete its files from the journal and record their SHA-256, so
    /// that the run can be part of a signed report.
    Recover {
        /// Run folder, or its name in the logs folder.
        run: PathBuf,
        /// Person who closes the run; named in the report.
        #[arg(long, value_name = "NAME", value_parser = person)]
        by: String,
        #[command(flatten)]
        logs: LogsArg,
    },
    /// Print the events of a run as JSON lines, also while it continues.
    Events(EventsArgs),
    /// Export a past run as a regenerated recording, as messages for ROS 2 tools, or as sensor readings.
    Export(ExportArgs),
    /// Locate a robot from the readings of a real system; write fixes, a track, a recording and a report.
    Locate(LocateArgs),
    /// Place the readings of an instrument on the track of a past run, by their time; the report judges them.
    Readings(ReadingsArgs),
    /// Show the result of a past run, or the combined result of a scan and its re-scans.
    Report(ReportArgs),
    /// Compare two surveys of one floor, years apart: growth, rates, new and gone indications.
    CompareSurveys(CompareSurveysArgs),
    /// Create a scenario that scans the areas missed by one or more past runs.
    Rescan(RescanArgs),
    /// Print shell completions for tankops.
    Completions {
        /// Shell to print completions for.
        shell: clap_complete::Shell,
    },
    /// Print the manual page of tankops or of one of its commands, in roff format.
    Man {
        /// Command of tankops.
        command: Option<String>,
    },
    /// Repeat the requests that a plugin received before it failed, and show each answer.
    ReplayWorker(ReplayWorkerArgs),
    /// Run a planner in this process; the console starts this command.
    #[command(hide = true)]
    Worker,
    /// Give the terminal to this process's group; a console that has lost the terminal starts this command.
    #[command(hide = true)]
    TakeTerminal,
}

fn person(text: &str) -> Result<String, String> {
    let is_one_line = !text.trim().contains(char::is_control);
    let is_name = is_one_line && !account::says_nothing(text) && foreign::unplain(text).is_none();
    let name = is_name.then(|| text.trim().to_owned());
    name.ok_or_else(|| "write the name of the person who takes responsibility, on one line".into())
}

#[cfg(test)]
mod tests;
