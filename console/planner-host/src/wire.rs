//! The protocol between console and worker.
//!
//! A frame is `u32 length | u8 kind | u32 sequence | u32 soft deadline | body`, little-endian. The length covers
//! everything after the length itself; the soft deadline is in microseconds, and zero means no deadline. Every request
//! gets one answer with the same sequence number. A CANCEL may follow a request and is never answered. Before the
//! answer to a PLAN, and nowhere else, any number of PROGRESS frames may be sent with the sequence number of the
//! request; they are never answered. The answer to a LOAD is preceded by one SEALED frame, which is sent before any
//! code of the plugin runs.

pub(crate) mod answer;
pub(crate) mod body;
#[cfg(test)]
mod damaged;
pub(crate) mod frame;
pub(crate) mod request;

use rustix::process::Signal;
use std::time::Duration;

/// The version of the protocol, raised whenever the form of a frame changes. Console and worker must be the same build.
pub(crate) const VERSION: u32 = 7;
/// The maximum length of a frame, bytes.
pub(crate) const LONGEST: usize = 16 << 20;
/// The signal with which a worker ends itself when it can no longer communicate with its console. An exit code would
/// not do, because any exit code may be the planner's own. On Linux, nothing else uses this signal.
#[cfg(target_os = "linux")]
pub(crate) const CHANNEL_LOST: Signal = Signal::STKFLT;
#[cfg(not(target_os = "linux"))]
pub(crate) const CHANNEL_LOST: Signal = Signal::USR2;
/// Maximum time for a worker that is asked to shut down to destroy its planner cleanly.
pub(crate) const SHUT_DOWN_WITHIN: Duration = Duration::from_millis(100);

/// Kinds of frames.
pub(crate) mod kind {
    pub(crate) const LOAD: u8 = 1;
    pub(crate) const CONFIGURE: u8 = 2;
    pub(crate) const RECONFIGURE: u8 = 3;
    pub(crate) const PLAN: u8 = 4;
    pub(crate) const STEP: u8 = 5;
    pub(crate) const SNAPSHOT: u8 = 6;
    pub(crate) const RESTORE: u8 = 7;
    pub(crate) const CANCEL: u8 = 8;
    /// The answer.
    pub(crate) const DONE: u8 = 0x80;
    /// The planner refused.
    pub(crate) const FAILED: u8 = 0x81;
    /// The loader refused.
    pub(crate) const REFUSED: u8 = 0x82;
    /// Progress of a plan; the answer follows.
    pub(crate) const PROGRESS: u8 = 0x83;
    /// The extent of the worker's sandbox, and the file to load. The descriptor that reports the worker's calls is sent
    /// with it.
    pub(crate) const SEALED: u8 = 0x84;
    /// This machine prevents the worker from running; the library is not to blame.
    pub(crate) const UNABLE: u8 = 0x85;
}
