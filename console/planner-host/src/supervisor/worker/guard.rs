//! The console's side of a worker's sandbox: its extent, and the decisions on system calls.

use crate::sandbox::{Listener, Stage, Uncounted, Verdict, ends_loading, verdict};
use crate::wire::answer::Sealed;
use mission::Sandbox;
use rustix::net::{RecvAncillaryBuffer, RecvAncillaryMessage, RecvFlags, recvmsg};
use std::io::{self, IoSliceMut, Read};
use std::mem::MaybeUninit;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::os::unix::net::UnixStream;

/// The guard of one worker.
#[derive(Default)]
pub(super) struct Guard {
    /// `None` until the worker has reported the extent.
    sealed: Option<Sealed>,
    /// The last descriptor received over the socket.
    received: Option<OwnedFd>,
    listener: Option<Listener>,
    has_loaded: bool,
    /// The folder that was last searched for a library.
    sought: String,
    uncounted: Uncounted,
}

impl Guard {
    /// Creates the guard for a planner with this memory limit, bytes.
    pub(super) fn new(memory_limit_bytes: u64) -> Self {
        Self { uncounted: Uncounted::of(memory_limit_bytes), ..Self::default() }
    }

    /// Returns the worker's report on its sandbox and on the plugin file, once it has arrived.
    pub(super) fn sealed(&self) -> Option<&Sealed> {
        self.sealed.as_ref()
    }

    /// Accepts the worker's report, which arrives before any code of the plugin has run. Returns false if there was an
    /// earlier report.
    pub(super) fn begin(&mut self, sealed: Sealed) -> bool {
        if self.sealed.is_some() {
            return false;
        }
        self.listener = self.received.take().map(Listener::new);
        self.sealed = Some(sealed);
        true
    }

    fn stage(&self) -> Stage {
        if !self.has_loaded {
            return Stage::Loading;
        }
        let is_full = self.sealed.as_ref().is_some_and(|sealed| sealed.sandbox == Sandbox::Full);
        Stage::Loaded { no_file_can_be_opened: is_full }
    }

    /// Notes that the plugin is loaded.
    pub(super) fn end_loading(&mut self) {
        self.has_loaded = true;
    }

    /// Returns the descriptor that becomes readable when a call waits for a decision.
    pub(super) fn calls(&self) -> Option<BorrowedFd<'_>> {
        self.listener.as_ref().map(AsFd::as_fd)
    }

    /// Decides on the waiting call. If the call is forbidden, returns what was tried.
    pub(super) fn decide(&mut self) -> Option<String> {
        let stage = self.stage();
        let listener = self.listener.as_ref()?;
        let call = listener.next()?;
        let about_memory = self.uncounted.verdict(&call);
        let verdict = about_memory.unwrap_or_else(|| verdict(&call, stage, &mut self.sought));
        self.has_loaded |= ends_loading(&call);
        listener.answer(&call, &verdict);
        match verdict {
            Verdict::Forbid(what) => Some(what),
            _ => None,
        }
    }

    /// Returns a reader of the socket; until the worker has reported, it also accepts a descriptor.
    pub(super) fn read<'a>(&'a mut self, socket: &'a UnixStream) -> impl Read + 'a {
        Reader { socket, received: self.sealed.is_none().then_some(&mut self.received) }
    }
}

struct Reader<'a> {
    socket: &'a UnixStream,
    received: Option<&'a mut Option<OwnedFd>>,
}

impl Read for Reader<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let Some(received) = &mut self.received else { return self.socket.read(bytes) };
        let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmRights(1))];
        let mut control = RecvAncillaryBuffer::new(&mut space);
        let message =
            recvmsg(self.socket, &mut [IoSliceMut::new(bytes)], &mut control, RecvFlags::CMSG_CLOEXEC)?;
        for part in control.drain() {
            if let RecvAncillaryMessage::ScmRights(descriptors) = part {
                **received = descriptors.last();
            }
        }
        Ok(message.bytes)
    }
}
