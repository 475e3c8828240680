//! Waits for a scenario from a pipe. The writer of the pipe may be slow, so a note tells the user that the program is
//! waiting.

use crate::cli::{Command, VehicleCommand};
use crate::planners::is_plugin;
use interactive::config;
use report::print::warn_line;
use rustix::{
    event::{PollFd, PollFlags, Timespec, poll},
    fs::OFlags,
};
use std::{
    fs::{File, OpenOptions},
    os::unix::fs::{FileTypeExt, OpenOptionsExt},
    path::{Path, PathBuf},
};

/// The wait after which a note is printed.
const SOON: Timespec = Timespec { tv_sec: 1, tv_nsec: 0 };

/// Waits until each pipe among a command's first input files has data. The returned files keep the pipes open until the
/// command reads them; otherwise a writer would lose its reader.
pub(crate) fn for_pipes(command: Option<&Command>) -> Vec<File> {
    files(command).iter().filter_map(|file| wait(file)).collect()
}

fn files(command: Option<&Command>) -> Vec<PathBuf> {
    match command {
        Some(Command::Run(args)) => vec![args.scenario.clone()],
        Some(Command::Vehicle(VehicleCommand::Simulate(args))) => vec![args.scenario.clone()],
        Some(Command::Plan(args)) => vec![args.scenario.clone()],
        Some(Command::Accuracy(args)) => vec![args.scenario.clone()],
        Some(Command::Locate(args)) => vec![args.scenario.clone()],
        Some(Command::Console(args)) => args.scenario.iter().cloned().collect(),
        // A configuration and a plugin must be regular files, so no wait is needed.
        Some(Command::Check { files, .. }) => {
            files.iter().filter(|file| !config::is_one(file) && !is_plugin(file)).cloned().collect()
        }
        _ => Vec::new(),
    }
}

fn wait(file: &Path) -> Option<File> {
    if !file.metadata().is_ok_and(|about| about.file_type().is_fifo()) {
        return None;
    }
    let pipe =
        OpenOptions::new().read(true).custom_flags(OFlags::NONBLOCK.bits().cast_signed()).open(file).ok()?;
    let has_come = |within| poll(&mut [PollFd::new(&pipe, PollFlags::IN)], within).is_ok_and(|n| n > 0);
    if !has_come(Some(&SOON)) {
        warn_line(&format!("note: waiting for data from the pipe {}", file.display()));
        has_come(None);
    }
    Some(pipe)
}
