//! The program `tankops-research`: the papers' tables, and the search for parameters. `tankops reproduce` and
//! `tankops tune` start it.

mod reproduce;
mod study_folder;
mod tune;

use clap::{Parser, Subcommand};
use command::{
    arguments::{PluginArgs, ReproduceArgs, TuneArgs},
    machine,
    start::{close_memory, fail, survive_file_size_limit},
    threads,
};
use std::process::ExitCode;

/// Studies of papers, and the search for parameters.
#[derive(Debug, Parser)]
#[command(name = "tankops-research", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    plugins: PluginArgs,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Reproduce a table or figure of a paper, and compare our values with the printed ones.
    Reproduce(ReproduceArgs),
    /// Optimize planner parameters on one set of layouts, and evaluate them on another.
    Tune(TuneArgs),
    /// Run as the worker process of a planner.
    #[command(hide = true)]
    Worker,
}

fn main() -> ExitCode {
    if let Err(error) = machine::check_stack() {
        return fail(&error);
    }
    let cli = Cli::parse();
    if matches!(cli.command, Command::Worker) {
        return planner_host::worker_main();
    }
    close_memory();
    survive_file_size_limit();
    run(&cli).unwrap_or_else(|error| fail(&error))
}

fn run(cli: &Cli) -> anyhow::Result<ExitCode> {
    let plugins = cli.plugins.dirs()?;
    machine::check()?;
    match &cli.command {
        Command::Reproduce(args) => {
            let flies = args.name.is_some() && !args.list;
            threads::check(if flies { threads::missions(args.threads) } else { 0 })?;
            reproduce::reproduce(args, &plugins)
        }
        Command::Tune(args) => {
            threads::check(threads::missions(args.threads))?;
            tune::tune(args, &plugins)
        }
        Command::Worker => Ok(planner_host::worker_main()),
    }
}
