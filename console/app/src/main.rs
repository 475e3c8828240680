//! tankops: console for robots that inspect the floors of oil storage tanks.

mod accuracy;
mod campaign;
mod cli;
mod compare_surveys;
mod events;
mod export;
mod headless;
mod import;
mod input;
mod locate;
mod manual;
mod map;
mod map_of;
mod new_planner;
mod new_vehicle;
mod output;
mod package;
mod past_runs;
mod plan;
mod planners;
mod progress;
mod readings;
mod replay_worker;
mod report_file;
mod rescan;
mod research;
mod shadowing;
mod signing;
mod stop_signal;
mod threads;
mod trial;
mod vehicle;
mod vehicle_trial;
mod waiting;

use clap::Parser;
use cli::{Cli, Command, ConsoleArgs, LogsArg, VehicleCommand};
use command::{
    machine,
    start::{close_memory, fail, survive_file_size_limit},
};
use flight::scenarios;
use planner_host::PluginDirs;
use scenario::Settings;
use std::{io::IsTerminal, process::ExitCode};

fn main() -> ExitCode {
    if let Err(error) = machine::check_stack() {
        return fail(&error);
    }
    let cli = Cli::parse();
    if matches!(cli.command, Some(Command::Worker)) {
        return planner_host::worker_main();
    }
    if matches!(cli.command, None | Some(Command::Console(_) | Command::Replay(_))) {
        keep_memory_small();
    }
    close_memory();
    survive_file_size_limit();
    dispatch(cli).unwrap_or_else(|error| fail(&error))
}

/// Makes the allocator return large blocks to the system immediately and use one heap for all threads. With a heap per
/// thread and cached blocks, a console would hold twice the memory that it uses. Headless runs keep the default,
/// because at full speed their threads would wait for each other.
fn keep_memory_small() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    #[expect(unsafe_code, reason = "the C library offers no other way for a process to set this")]
    // SAFETY: `mallopt` changes parameters of the allocator under its own lock; no other thread runs yet.
    unsafe {
        /// Size, in bytes, from which a block gets a mapping of its own and is unmapped when freed.
        const MAPPED_FROM: libc::c_int = 128 << 10;
        // If a parameter is refused, its default stays in effect.
        libc::mallopt(libc::M_MMAP_THRESHOLD, MAPPED_FROM);
        libc::mallopt(libc::M_ARENA_MAX, 1);
    }
}

fn dispatch(cli: Cli) -> anyhow::Result<ExitCode> {
    let plugins = cli.plugins.dirs()?;
    machine::check()?;
    command::threads::check(threads::needed(cli.command.as_ref()))?;
    let _pipes = waiting::for_pipes(cli.command.as_ref());
    match cli.command {
        None => by_default(&plugins),
        Some(Command::Console(args)) => interactive::open(&args.into(), &plugins),
        Some(Command::Run(args)) => headless::run(&args, &plugins),
        Some(Command::Plan(args)) => plan::plan(&args, &plugins),
        Some(Command::Vehicle(VehicleCommand::Simulate(args))) => vehicle::simulate(&args),
        Some(Command::Accuracy(args)) => accuracy::accuracy(&args, &plugins),
        Some(Command::Map(args)) => map::map(&args),
        Some(Command::MapOf(args)) => map_of::map_of(&args, &plugins),
        Some(Command::Import(args)) => import::import(&args, &plugins),
        Some(Command::NewPlanner(args)) => new_planner::create(&args),
        Some(Command::Planners { json }) => planners::list(&plugins, json),
        Some(Command::NewVehicle(args)) => new_vehicle::create(&args),
        Some(Command::Check { json, trial, .. }) if trial.vehicle.is_some() => {
            vehicle_trial::check(&trial, json)
        }
        Some(Command::Check { files, fly: Some(n), seed, json, keep, .. }) => {
            trial::fly(&files, &plugins, (n, seed), json, keep.as_deref())
        }
        Some(Command::Check { files, .. }) => planners::check(&files, &plugins),
        Some(Command::Reproduce(_) | Command::Tune(_)) => research::hand_over(),
        Some(Command::Replay(args)) => interactive::open(&args.into(), &plugins),
        Some(Command::Campaign(command)) => campaign::campaign(&command, &plugins),
        Some(Command::Runs { json, logs }) => past_runs::list(&logs, json),
        Some(Command::Verify { run, from_journal, logs }) => {
            past_runs::verify(&run, &logs, &plugins, from_journal)
        }
        Some(Command::Recover { run, by, logs }) => past_runs::recover(&run, &by, &logs),
        Some(Command::Events(args)) => events::events(&args),
        Some(Command::Export(args)) => export::export(&args),
        Some(Command::Locate(args)) => locate::locate(&args),
        Some(Command::Readings(args)) => readings::readings(&args),
        Some(Command::Report(args)) => past_runs::report(&args, &plugins),
        Some(Command::CompareSurveys(args)) => compare_surveys::compare(&args),
        Some(Command::Rescan(args)) => rescan::rescan(&args, &plugins),
        Some(Command::ReplayWorker(args)) => replay_worker::replay(&args),
        Some(Command::Completions { shell }) => manual::completions(shell),
        Some(Command::Man { command }) => manual::man(command.as_deref()),
        Some(Command::Worker) => Ok(planner_host::worker_main()),
        Some(Command::TakeTerminal) => Ok(interactive::take_terminal()),
    }
}

/// Opens the console on the demo or, without a terminal, runs the demo headless.
fn by_default(plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    if std::io::stdout().is_terminal() && std::io::stdin().is_terminal() {
        return interactive::open(&ConsoleArgs::default().into(), plugins);
    }
    headless::fly(
        &scenarios::demo(&Settings::default())?,
        plugins,
        &LogsArg::default(),
        headless::RunOptions { json: false, record: true, live_deadlines: false },
    )
}
