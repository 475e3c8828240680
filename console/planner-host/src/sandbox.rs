//! What a worker cannot reach, whatever its plugin does.
//!
//! Two locks of the Linux kernel close the process before the first instruction of a plugin runs, for a probe as for a
//! mission. *Landlock* takes files and network from it: while the plugin is loaded it may read libraries, afterwards
//! nothing. *seccomp* allows the calls of the system that computing takes; every other call waits until the console has
//! decided ([`verdict`]), which ends the process and names the call. The plugin has no part in that: the kernel itself
//! reports the call, over a descriptor that the plugin never sees.

#[cfg(target_os = "linux")]
mod about;
#[cfg(target_os = "linux")]
mod calls;
#[cfg(not(target_os = "linux"))]
mod elsewhere;
#[cfg(target_os = "linux")]
mod files;
#[cfg(target_os = "linux")]
mod listener;
#[cfg(target_os = "linux")]
mod memory;
#[cfg(target_os = "linux")]
mod verdict;

#[cfg(not(target_os = "linux"))]
pub(crate) use elsewhere::{
    Listener, MAY_HIDE, MAY_RESERVE, Uncounted, Verdict, close_all_but, close_files, ends_loading, seal,
    verdict,
};
#[cfg(target_os = "linux")]
pub(crate) use {
    files::nothing as close_files,
    listener::{Listener, close_all_but},
    memory::{MAY_HIDE, MAY_RESERVE, Uncounted},
    verdict::{Verdict, ends_loading, verdict},
};

use mission::Sandbox;
use std::os::fd::OwnedFd;

/// The bytes of a worker's plugin are at this descriptor, above the numbers that careless plugins close.
#[cfg(target_os = "linux")]
pub(crate) const PLUGIN_AT: i32 = 201;
/// The same as a path; what it is opened for again are names of functions.
#[cfg(target_os = "linux")]
const PLUGIN: &str = "/proc/self/fd/201";

/// How far a worker is with its plugin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Its libraries are being read.
    Loading,
    /// It is loaded.
    Loaded {
        /// Landlock is in force.
        no_file_can_be_opened: bool,
    },
}

/// A process that was closed off.
pub(crate) struct ClosedOff {
    /// How far.
    pub(crate) sandbox: Sandbox,
    /// Where the console learns what the process wants to do beyond computing.
    pub(crate) listener: Option<OwnedFd>,
    /// Whether files are still to be closed, by [`close_files`], once the plugin is loaded.
    pub(crate) reads_libraries: bool,
}

/// Closes this process off. It must have one thread: what others do would not be covered.
#[cfg(target_os = "linux")]
pub(crate) fn seal() -> ClosedOff {
    let files = files::only_libraries();
    let calls = calls::install();
    let sandbox = match (&files, &calls) {
        (Ok(()), Ok(_)) => Sandbox::Full,
        (Err(files), Ok(_)) => Sandbox::Partial(format!("Landlock: {files}")),
        (Ok(()), Err(calls)) => Sandbox::Partial(format!("seccomp: {calls}")),
        (Err(files), Err(calls)) => Sandbox::None(format!("Landlock: {files}; seccomp: {calls}")),
    };
    ClosedOff { sandbox, reads_libraries: files.is_ok(), listener: calls.ok() }
}
