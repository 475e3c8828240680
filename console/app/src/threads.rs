//! The threads and processes that the system grants.

use crate::cli::{CampaignCommand, Command};
use anyhow::anyhow;
use std::{
    fs,
    sync::{Mutex, PoisonError},
    thread::{self, available_parallelism},
    time::{Duration, Instant},
};

/// Threads and processes at once, besides the first thread, counted with `prlimit --nproc`. What planners start beyond their
/// process is counted only where something else needs it: ours do without where they get none.
mod each {
    /// A planner: its process, and the thread in it that ends it with the console.
    pub(super) const PLANNER: usize = 2;
    /// A past run that is read: its events, and the digests of its files.
    pub(super) const PAST_RUN: usize = 2;
    /// A recording: the recorder and the threads of the recording SDK.
    pub(super) const RECORDING: usize = 8;
    /// A journal, whether it is written or only hashed.
    pub(super) const JOURNAL: usize = 1;
    /// A run that is written.
    pub(super) const RUN: usize = RECORDING + JOURNAL;
    /// Who waits for a signal.
    pub(super) const SIGNAL: usize = 1;
    /// A run that is recomputed: its journal, its planners, and its files meanwhile.
    pub(super) const VERIFY: usize = 3 + PAST_RUN + PLANNER;
    /// A console: signals, keys, plugins, and the work beside the screen.
    pub(super) const CONSOLE: usize = 5;
}

/// Within this the system has cleared away threads that have ended, even on a busy machine.
const CLEARED_WITHIN: Duration = Duration::from_secs(1);
/// They do nothing.
const STACK_BYTES: usize = 64 << 10;

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
        Some(Command::Reproduce(args)) if args.name.is_some() && !args.list => missions(args.threads),
        Some(Command::Tune(args)) => missions(args.threads),
        Some(Command::Campaign(command)) => of_campaign(command),
        Some(
            Command::Accuracy(_)
            | Command::Map(_)
            | Command::Import(_)
            | Command::NewPlanner(_)
            | Command::Reproduce(_)
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

/// Missions that are flown at once without being recorded; 0: one for each core.
fn missions(at_once: usize) -> usize {
    each::SIGNAL + (1 + each::PLANNER) * if at_once > 0 { at_once } else { cores() }
}

fn cores() -> usize {
    available_parallelism().map_or(1, usize::from)
}

/// Makes sure that the system grants what a command needs, before it begins something that it could not end. Takes less than a
/// millisecond.
///
/// # Errors
/// It does not; the sentence names the limit.
pub(crate) fn check(needed: usize) -> anyhow::Result<()> {
    let before = running();
    let gate = Mutex::new(());
    let closed = gate.lock().unwrap_or_else(PoisonError::into_inner);
    let wait = || drop(gate.lock());
    thread::scope(|scope| {
        let start = |_| thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, wait).map(drop);
        let started = (0..needed).try_for_each(start);
        drop(closed);
        started
    })
    .map_err(|error| {
        anyhow!(
            "this command needs {} threads and processes, and the system grants fewer ({error}): `ulimit -u` limits them",
            needed + 1
        )
    })?;
    // Who has ended counts until the system has cleared it away.
    let until = Instant::now() + CLEARED_WITHIN;
    while running() > before && Instant::now() < until {
        thread::sleep(Duration::from_micros(50));
    }
    Ok(())
}

/// Threads of this process, where the system says so.
fn running() -> usize {
    fs::read_dir("/proc/self/task").map_or(0, Iterator::count)
}
