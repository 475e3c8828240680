//! How many threads and processes a command needs.

use crate::cli::{CampaignCommand, Command};
use command::threads::{cores, missions};

/// Threads and processes at once, besides the first thread, counted with `prlimit --nproc`. What planners start beyond their
/// process is counted only where something else needs it: ours do without where they get none.
mod each {
    pub(super) use command::threads::{PLANNER, SIGNAL};

    /// A past run that is read: its events, and the digests of its files.
    pub(super) const PAST_RUN: usize = 2;
    /// A recording: the recorder and the threads of the recording SDK.
    pub(super) const RECORDING: usize = 8;
    /// A journal, whether it is written or only hashed.
    pub(super) const JOURNAL: usize = 1;
    /// A run that is written.
    pub(super) const RUN: usize = RECORDING + JOURNAL;
    /// A run that is recomputed: its journal, its planners, and its files meanwhile.
    pub(super) const VERIFY: usize = 3 + PAST_RUN + PLANNER;
    /// A console: signals, keys, plugins, and the work beside the screen.
    pub(super) const CONSOLE: usize = 5;
}

/// How many threads and processes a command has at once at most, besides the first thread.
pub(crate) fn needed(command: Option<&Command>) -> usize {
    match command {
        None | Some(Command::Console(_) | Command::Replay(_)) => each::CONSOLE + each::PLANNER + each::RUN,
        Some(Command::Run(args)) if args.no_record => each::PLANNER + each::JOURNAL + each::SIGNAL,
        // What a planner of floor plans with, one a core, must not take what the recording needs.
        Some(Command::Run(_)) => each::PLANNER + cores() - 1 + each::RUN + each::SIGNAL,
        Some(
            Command::Plan(_)
            | Command::Planners { .. }
            | Command::Check { fly: None, .. }
            | Command::ReplayWorker(_),
        ) => each::PLANNER,
        Some(Command::Check { .. }) => missions(0),
        Some(Command::Verify { .. }) => each::VERIFY,
        Some(Command::Report(args)) if args.sign.is_some() => each::VERIFY,
        Some(Command::Report(_) | Command::Rescan(_) | Command::Recover { .. } | Command::Runs { .. }) => {
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
            // Another program, which asks for itself.
            | Command::Reproduce(_)
            | Command::Tune(_)
            | Command::Events(_)
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
