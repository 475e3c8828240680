//! The protocol between console and worker.
//!
//! A frame is `u32 length | u8 kind | u32 sequence | u32 soft deadline | body`, little-endian; the length counts
//! everything after itself, the soft deadline is in microseconds and zero for none. One request, one answer with the
//! request's sequence number; a CANCEL may follow a request and is never answered. Any number of PROGRESS frames with the
//! request's sequence number may come before the answer to a PLAN, and nowhere else; they are never answered either. One
//! SEALED frame comes before the answer to a LOAD, and before anything of the plugin runs.

pub(crate) mod answer;
pub(crate) mod body;
#[cfg(test)]
mod damaged;
pub(crate) mod frame;
pub(crate) mod request;

use rustix::process::Signal;
use std::time::Duration;

/// Raised whenever a frame changes its form: console and worker must be the same build.
pub(crate) const VERSION: u32 = 6;
/// Longest frame, bytes.
pub(crate) const LONGEST: usize = 16 << 20;
/// The signal with which a worker ends itself when it can no longer talk to its console. No exit code: those are the planner's;
/// and on Linux a signal that nothing uses.
#[cfg(target_os = "linux")]
pub(crate) const CHANNEL_LOST: Signal = Signal::STKFLT;
#[cfg(not(target_os = "linux"))]
pub(crate) const CHANNEL_LOST: Signal = Signal::USR2;
/// A worker that is asked to shut down is given this long to drop its planner cleanly.
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
    /// How far a plan is; the answer follows.
    pub(crate) const PROGRESS: u8 = 0x83;
    /// How far the worker is closed off, and for which file; the descriptor that reports its calls comes along.
    pub(crate) const SEALED: u8 = 0x84;
    /// The machine does not let the worker run; this says nothing about the library.
    pub(crate) const UNABLE: u8 = 0x85;
}
