//! For systems without Landlock and seccomp. They have no sandbox, and this is stated wherever the sandbox is shown.

use super::ClosedOff;
use mission::Sandbox;
use std::os::fd::{BorrowedFd, OwnedFd};

pub(crate) fn seal() -> ClosedOff {
    let sandbox = Sandbox::None("only Linux has Landlock and seccomp".to_owned());
    ClosedOff { sandbox, listener: None, reads_libraries: false }
}

pub(crate) fn close_files() -> Result<(), String> {
    Ok(())
}

/// Placeholder; this system reports no calls.
pub(crate) enum Listener {}

/// Placeholder; this system reports no calls.
pub(crate) enum Call {}

pub(crate) enum Verdict {
    Forbid(String),
}

impl Listener {
    pub(crate) fn new(_: OwnedFd) -> Self {
        unreachable!("no worker sends a descriptor on this system")
    }

    pub(crate) fn next(&self) -> Option<Call> {
        match *self {}
    }

    pub(crate) fn answer(&self, _: &Call, _: &Verdict) {
        match *self {}
    }
}

impl std::os::fd::AsFd for Listener {
    fn as_fd(&self) -> BorrowedFd<'_> {
        match *self {}
    }
}

pub(crate) fn verdict(call: &Call, _: super::Stage, _: &mut String) -> Verdict {
    match *call {}
}

/// Address space in addition to a planner's memory limit, bytes.
pub(crate) const MAY_RESERVE: u64 = 1 << 30;
/// Memory of a worker in addition to its planner's limit, bytes.
pub(crate) const MAY_HIDE: u64 = 32 << 20;

/// Placeholder; on this system no such memory is counted.
#[derive(Default)]
pub(crate) struct Uncounted;

impl Uncounted {
    pub(crate) fn of(_: u64) -> Self {
        Self
    }

    pub(crate) fn verdict(&mut self, call: &Call) -> Option<Verdict> {
        match *call {}
    }
}

pub(crate) fn ends_loading(call: &Call) -> bool {
    match *call {}
}

pub(crate) fn close_all_but(_: BorrowedFd<'_>) {}
