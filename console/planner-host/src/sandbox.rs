//! Prevents a worker from reaching anything outside its process, whatever its plugin does.
//!
//! Two mechanisms of the Linux kernel isolate the process before the first instruction of a plugin runs, in a probe as
//! well as in a mission. *Landlock* removes access to files and the network: while the plugin is being loaded, the
//! process can read libraries, and afterwards nothing. *seccomp* allows the system calls that are needed for computing.
//! Every other call waits for the console's decision ([`verdict`]); if the call is forbidden, the console kills the
//! process and names the call. The plugin cannot interfere: the kernel itself reports the call, through a descriptor
//! that the plugin never sees.

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

/// The descriptor of the worker's copy of the plugin. Its number is higher than those that careless plugins close.
#[cfg(target_os = "linux")]
pub(crate) const PLUGIN_AT: i32 = 201;
/// The path of the same copy, which is opened again only to look up function names.
#[cfg(target_os = "linux")]
const PLUGIN: &str = "/proc/self/fd/201";

/// The progress of a worker in loading its plugin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    /// The plugin's libraries are being read.
    Loading,
    /// The plugin is loaded.
    Loaded {
        /// Whether Landlock is in force.
        no_file_can_be_opened: bool,
    },
}

/// A process in its sandbox.
pub(crate) struct ClosedOff {
    /// The extent of the sandbox.
    pub(crate) sandbox: Sandbox,
    /// The descriptor through which the console receives all system calls that computing does not need.
    pub(crate) listener: Option<OwnedFd>,
    /// Whether access to files must still be removed, with [`close_files`], once the plugin is loaded.
    pub(crate) reads_libraries: bool,
}

/// Puts this process into the sandbox. The process must have only one thread, because the sandbox would not cover other
/// threads.
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
