//! tankops: console for robots that inspect the floors of oil storage tanks.

mod accuracy;
mod again;
mod answers;
mod cli;
mod console;
mod drawing;
mod failure;
mod flight;
mod headless;
mod output;
mod past_runs;
mod plan;
mod plan_watch;
mod planners;
mod preflight;
mod progress;
mod reproduce;
mod run_folder;
mod run_log;
mod stop_signal;
mod tune;
mod verify;

use clap::Parser;
use cli::{Changes, Cli, Command, ConsoleArgs, LogsArg};
use failure::bad_input;
use planner_host::PluginDirs;
use scenario::{Scenario, Settings};
use std::{
    io::IsTerminal,
    path::{Path, PathBuf},
    process::ExitCode,
    sync::Arc,
};

/// The demo, so that `tankops` shows something wherever it is started.
const DEMO: &str = include_str!("../../../scenarios/demo.toml");

fn main() -> ExitCode {
    let cli = Cli::parse();
    if matches!(cli.command, Some(Command::Worker)) {
        return planner_host::worker_main();
    }
    survive_file_size_limit();
    dispatch(cli).unwrap_or_else(|error| failure::report(&error))
}

/// A file that may not grow (`ulimit -f`) is an error of the write, as a full disk is, and not the end of the process.
///
/// A handler that does nothing, because ignoring the signal would be inherited by the planners' processes.
fn survive_file_size_limit() {
    // Without a handler the signal ends the process, as it does by default.
    let _ = signal_hook::flag::register(libc::SIGXFSZ, Arc::default());
}

fn dispatch(cli: Cli) -> anyhow::Result<ExitCode> {
    if let Some(missing) = cli.plugins.plugin_dir.iter().find(|dir| !dir.is_dir()) {
        return Err(bad_input(format!("--plugin-dir {}: there is no such folder", missing.display())));
    }
    let plugins = PluginDirs::standard(&cli.plugins.plugin_dir);
    match cli.command {
        None => by_default(&plugins),
        Some(Command::Console(args)) => {
            console::open(&console_scenario(&args)?, &args.logs, &plugins, args.drill)
        }
        Some(Command::Run(args)) => headless::run(&args, &plugins),
        Some(Command::Plan(args)) => plan::plan(&args, &plugins),
        Some(Command::Accuracy(args)) => accuracy::accuracy(&args),
        Some(Command::Planners { json }) => planners::list(&plugins, json),
        Some(Command::Check { files }) => planners::check(&files, &plugins),
        Some(Command::Reproduce(args)) => reproduce::reproduce(&args, &plugins),
        Some(Command::Tune(args)) => tune::tune(&args, &plugins),
        Some(Command::Runs { json, logs }) => past_runs::list(&logs, json),
        Some(Command::Verify { run, from_journal, logs }) => {
            verify::verify(&run, &logs, &plugins, from_journal)
        }
        Some(Command::Export { run, rrd, logs }) => past_runs::export(&run, &rrd, &logs),
        Some(Command::Report { runs, json, output, logs }) => {
            again::report(&runs, &logs, json, output.as_deref())
        }
        Some(Command::Rescan(args)) => again::rescan(&args, &plugins),
        Some(Command::Worker) => Ok(planner_host::worker_main()),
    }
}

/// The console on the demo, or, without a terminal, the demo flown headless.
fn by_default(plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let (scenario, logs) = (demo()?, LogsArg { logs: PathBuf::from("logs") });
    if std::io::stdout().is_terminal() && std::io::stdin().is_terminal() {
        return console::open(&scenario, &logs, plugins, None);
    }
    headless::fly(
        &scenario,
        plugins,
        &logs,
        headless::RunOptions { json: false, record: true, live_deadlines: false },
    )
}

fn demo() -> anyhow::Result<Scenario> {
    Scenario::parse(DEMO, "the demo scenario").map_err(|errors| bad_input(errors.render()))
}

fn console_scenario(args: &ConsoleArgs) -> anyhow::Result<Scenario> {
    match &args.scenario {
        Some(path) => read_scenario(path, &args.changes),
        None => Scenario::parse_with(DEMO, "the demo scenario", &settings(&args.changes))
            .map_err(|errors| bad_input(errors.render())),
    }
}

/// Reads a scenario with what the command line changes in it.
fn read_scenario(path: &Path, changes: &Changes) -> anyhow::Result<Scenario> {
    Scenario::read_with(path, &settings(changes)).map_err(|errors| bad_input(errors.render()))
}

fn settings(changes: &Changes) -> Settings {
    Settings { planner: changes.planner.clone(), seed: changes.seed, set: changes.set.clone() }
}
