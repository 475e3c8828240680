//! `tankops reproduce` and `tankops tune` belong to a separate program, so operators do not have to build it.

use anyhow::Context;
use flight::failure::bad_input;
use std::{env, os::unix::process::CommandExt, process, process::ExitCode};

/// The name of that program, which is in the same folder as this one.
const PROGRAM: &str = "tankops-research";

/// Replaces this process with the other program, with the same arguments.
///
/// # Errors
/// The program does not exist or cannot be started.
pub(crate) fn hand_over() -> anyhow::Result<ExitCode> {
    let program = env::current_exe().context("locating the program's own file")?.with_file_name(PROGRAM);
    if !program.exists() {
        return Err(bad_input(format!(
            "this command needs the program {}, which does not exist: build it with `cargo build --release --workspace`",
            program.display()
        )));
    }
    let failed = process::Command::new(&program).args(env::args_os().skip(1)).exec();
    Err(failed).with_context(|| format!("starting {}", program.display()))
}
