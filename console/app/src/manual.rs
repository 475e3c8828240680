//! Shell completions and manual pages of the command line.

use crate::cli::Cli;
use anyhow::Context;
use clap::CommandFactory;
use clap_complete::Shell;
use flight::failure::{COMPLETE, bad_input};
use report::print::say;
use std::process::ExitCode;

/// Runs `tankops completions`.
pub(crate) fn completions(shell: Shell) -> anyhow::Result<ExitCode> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "tankops", &mut text);
    print(text)
}

/// Runs `tankops man`.
pub(crate) fn man(command: Option<&str>) -> anyhow::Result<ExitCode> {
    let mut whole = Cli::command();
    // Adds the global options to each command.
    whole.build();
    let page = match command {
        None => whole,
        Some(name) => {
            let found = whole.find_subcommand(name).filter(|command| !command.is_hide_set());
            let found = found.ok_or_else(|| bad_input(format!("tankops has no command `{name}`")))?;
            found.clone().display_name(format!("tankops-{name}"))
        }
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page).render(&mut text).context("writing the manual page")?;
    print(text)
}

fn print(text: Vec<u8>) -> anyhow::Result<ExitCode> {
    say(&String::from_utf8(text).context("reading the generated page")?)?;
    Ok(ExitCode::from(COMPLETE))
}
