//! tankops: console for robots that inspect the floors of oil storage tanks.

mod accuracy;
mod campaign;
mod cli;
mod events;
mod export;
mod headless;
mod import;
mod input;
mod locate;
mod machine;
mod manual;
mod map;
mod new_planner;
mod output;
mod past_runs;
mod plan;
mod planners;
mod progress;
mod replay_worker;
mod report_file;
mod reproduce;
mod rescan;
mod shadowing;
mod shared_folder;
mod signing;
mod stop_signal;
mod study_folder;
mod threads;
mod trial;
mod tune;
mod waiting;

use clap::Parser;
use cli::{Cli, Command, ConsoleArgs, LogsArg};
use flight::{
    failure::{BAD_INPUT, INTERNAL, bad_input, is_input},
    scenarios,
};
use planner_host::PluginDirs;
use report::print::warn_line;
use scenario::Settings;
use std::{io::IsTerminal, process::ExitCode, sync::Arc};

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

/// Reports a failure on stderr; the exit code distinguishes input errors from internal ones.
fn fail(error: &anyhow::Error) -> ExitCode {
    if is_input(error) {
        let text = error.to_string();
        let prefix = if text.starts_with("error") { "" } else { "error: " };
        warn_line(&format!("{prefix}{}", text.trim_end()));
        return ExitCode::from(BAD_INPUT);
    }
    warn_line(&format!("error: {error:#}"));
    ExitCode::from(INTERNAL)
}

/// Has the allocator give large blocks back to the system at once, and all threads share one heap: with a heap for each
/// thread and blocks kept for later, a console holds twice what it uses. Headless runs do without: at full speed their threads would wait for each other.
fn keep_memory_small() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    #[expect(unsafe_code, reason = "the C library has no other way to set this from within")]
    // SAFETY: `mallopt` changes parameters of the allocator under its own lock; no other thread runs yet.
    unsafe {
        /// Blocks from this size on are mapped for themselves and unmapped when they are freed, bytes.
        const MAPPED_FROM: libc::c_int = 128 << 10;
        // A parameter that is refused keeps its default.
        libc::mallopt(libc::M_MMAP_THRESHOLD, MAPPED_FROM);
        libc::mallopt(libc::M_ARENA_MAX, 1);
    }
}

/// Keeps other processes of the same user, planners among them, from reading or changing this one; leaves no core dump.
fn close_memory() {
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{DumpableBehavior, set_dumpable_behavior};
        // Where the system refuses, planners are still closed off.
        let _ = set_dumpable_behavior(DumpableBehavior::NotDumpable);
    }
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
    machine::check()?;
    threads::check(threads::needed(cli.command.as_ref()))?;
    let _pipes = waiting::for_pipes(cli.command.as_ref());
    let plugins = PluginDirs {
        requires_sandbox: cli.plugins.require_sandbox,
        ..PluginDirs::standard(&cli.plugins.plugin_dir)
    };
    match cli.command {
        None => by_default(&plugins),
        Some(Command::Console(args)) => interactive::open(&args.into(), &plugins),
        Some(Command::Run(args)) => headless::run(&args, &plugins),
        Some(Command::Plan(args)) => plan::plan(&args, &plugins),
        Some(Command::Accuracy(args)) => accuracy::accuracy(&args),
        Some(Command::Map(args)) => map::map(&args),
        Some(Command::Import(args)) => import::import(&args, &plugins),
        Some(Command::NewPlanner(args)) => new_planner::create(&args),
        Some(Command::Planners { json }) => planners::list(&plugins, json),
        Some(Command::Check { files, fly: Some(n), seed, json, keep }) => {
            trial::fly(&files, &plugins, (n, seed), json, keep.as_deref())
        }
        Some(Command::Check { files, .. }) => planners::check(&files, &plugins),
        Some(Command::Reproduce(args)) => reproduce::reproduce(&args, &plugins),
        Some(Command::Tune(args)) => tune::tune(&args, &plugins),
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
        Some(Command::Report(args)) => past_runs::report(&args, &plugins),
        Some(Command::Rescan(args)) => rescan::rescan(&args, &plugins),
        Some(Command::ReplayWorker(args)) => replay_worker::replay(&args),
        Some(Command::Completions { shell }) => manual::completions(shell),
        Some(Command::Man { command }) => manual::man(command.as_deref()),
        Some(Command::Worker) => Ok(planner_host::worker_main()),
        Some(Command::TakeTerminal) => Ok(interactive::take_terminal()),
    }
}

/// The console on the demo, or, without a terminal, the demo flown headless.
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
