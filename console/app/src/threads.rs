//! The number of threads and processes that each command needs.

use crate::cli::{CampaignCommand, Command};
use command::threads::{cores, missions};

/// Numbers of simultaneous threads and processes besides the first thread, as counted by `prlimit --nproc`. Additional
/// threads of a planner are counted only if they could use up threads that another part of the command needs; the
/// planners of tankops work without them.
mod each {
    pub(super) use command::threads::{PLANNER, SIGNAL};

    /// Reading a past run: its events, and the digests of its files.
    pub(super) const PAST_RUN: usize = 2;
    /// Writing a recording: the recorder and the threads of the recording SDK.
    pub(super) const RECORDING: usize = 8;
    /// Writing a journal, or only hashing it.
    pub(super) const JOURNAL: usize = 1;
    /// Writing a run.
    pub(super) const RUN: usize = RECORDING + JOURNAL;
    /// Recomputing a run: its journal and planners and, at the same time, its files.
    pub(super) const VERIFY: usize = 3 + PAST_RUN + PLANNER;
    /// Threads for the consoles that are connected to a vehicle that this program offers.
    pub(super) const CONNECTIONS: usize = 17;
    /// The console: signals, keys, plugins, and background work.
    pub(super) const CONSOLE: usize = 5;
}

/// The largest number of simultaneous threads and processes of a command, besides the first thread.
pub(crate) fn needed(command: Option<&Command>) -> usize {
    match command {
        None | Some(Command::Console(_) | Command::Replay(_)) => each::CONSOLE + each::PLANNER + each::RUN,
        // Connections: each has two threads.
        Some(Command::Vehicle(_)) => each::SIGNAL + each::CONNECTIONS,
        Some(Command::Run(args)) if args.no_record => each::PLANNER + each::JOURNAL + each::SIGNAL,
        // A coverage planner plans with one thread per core; these must not use up the threads that the recording
        // needs.
        Some(Command::Run(_)) => each::PLANNER + cores() - 1 + each::RUN + each::SIGNAL,
        // Both connections of a trial, each with a thread.
        Some(Command::Check { trial, .. }) if trial.vehicle.is_some() => each::SIGNAL + 2,
        Some(
            Command::Plan(_)
            | Command::Planners { .. }
            | Command::Check { fly: None, .. }
            | Command::ReplayWorker(_),
        ) => each::PLANNER,
        Some(Command::Check { .. }) => missions(0),
        Some(Command::Verify { .. }) => each::VERIFY,
        Some(Command::Report(args)) if args.sign.is_some() => each::VERIFY,
        Some(
            Command::Report(_)
            | Command::CompareSurveys(_)
            | Command::MapOf(_)
            | Command::Rescan(_)
            | Command::Recover { .. }
            | Command::Runs { .. },
        ) => {
            each::PAST_RUN
        }
        Some(Command::Export(args)) if args.to.rrd.is_none() && args.to.ranges.is_none() => each::PAST_RUN,
        Some(Command::Export(_)) => each::RECORDING,
        Some(Command::Locate(_)) => each::RUN + each::SIGNAL,
        Some(Command::Campaign(command)) => of_campaign(command),
        Some(
            Command::Accuracy(_)
            | Command::Map(_)
            | Command::Import(_)
            | Command::NewPlanner(_)
            | Command::NewVehicle(_)
            // A different program, which checks its own limits.
            | Command::Reproduce(_)
            | Command::Tune(_)
            | Command::Events(_)
            | Command::Readings(_)
            | Command::Completions { .. }
            | Command::Man { .. }
            | Command::Worker
            | Command::TakeTerminal,
        ) => 0,
    }
}

fn of_campaign(command: &CampaignCommand) -> usize {
    match command {
        CampaignCommand::Run(args) => missions(args.jobs),
        CampaignCommand::Work(args) => missions(args.threads),
        CampaignCommand::Prepare(_) => each::PLANNER,
        CampaignCommand::Status { .. } | CampaignCommand::Merge { .. } | CampaignCommand::Compare(_) => 0,
    }
}
