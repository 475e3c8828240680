//! How long the console waits for the request at hand.

use super::telling::Telling;
use crate::Progress;
use crate::loader::Watch;
use crate::wire::frame::{Incoming, KIND_AT};
use crate::wire::kind;
use rustix::net::{RecvFlags, recv};
use std::cell::Cell;
use std::os::fd::OwnedFd;
use std::time::{Duration, Instant};

/// The socket is looked at no more often than this.
const PEEK_EVERY: Duration = Duration::from_millis(1);

/// Deadline of a request, and whether a CANCEL is waiting behind it.
pub(super) struct Patience {
    socket: OwnedFd,
    deadline: Cell<Option<Instant>>,
    peeked: Cell<Instant>,
    cancelled: Cell<bool>,
    watched: Cell<bool>,
    telling: Telling,
}

impl Patience {
    /// No request yet.
    ///
    /// # Errors
    /// When the socket cannot be had twice.
    pub(super) fn new(socket: OwnedFd) -> std::io::Result<Self> {
        let telling = Telling::new(socket.try_clone()?);
        Ok(Self {
            socket,
            deadline: Cell::new(None),
            peeked: Cell::new(Instant::now()),
            cancelled: Cell::new(false),
            watched: Cell::new(false),
            telling,
        })
    }

    /// A request arrived; only a CANCEL can have arrived behind it.
    pub(super) fn begin(&self, request: &Incoming) {
        let now = Instant::now();
        self.deadline.set(request.soft_deadline().and_then(|within| now.checked_add(within)));
        self.peeked.set(now);
        self.cancelled.set(request.has_more());
        self.telling.begin(request.kind(), request.sequence());
    }

    /// Whether anyone looks at drawings of this request.
    pub(super) fn set_watched(&self, watched: bool) {
        self.watched.set(watched);
    }

    fn is_cancel_waiting(&self) -> bool {
        let mut head = [0_u8; KIND_AT + 1];
        match recv(&self.socket, &mut head[..], RecvFlags::PEEK | RecvFlags::DONTWAIT) {
            // The console hung up.
            Ok((0, _)) => true,
            Ok((n, _)) => n == head.len() && head[KIND_AT] == kind::CANCEL,
            Err(_) => false,
        }
    }
}

impl Watch for Patience {
    fn should_stop(&self) -> u32 {
        if self.cancelled.get() {
            return 1;
        }
        let now = Instant::now();
        self.telling.catch_up(now);
        if self.deadline.get().is_some_and(|deadline| now >= deadline) {
            return 2;
        }
        if now - self.peeked.get() >= PEEK_EVERY {
            self.peeked.set(now);
            self.cancelled.set(self.is_cancel_waiting());
        }
        u32::from(self.cancelled.get())
    }

    fn time_left_s(&self) -> f64 {
        let left = self.deadline.get().map(|deadline| deadline.saturating_duration_since(Instant::now()));
        left.map_or(f64::INFINITY, |left| left.as_secs_f64())
    }

    fn wants_drawing(&self) -> bool {
        self.watched.get()
    }

    fn take_progress(&self, progress: Progress) {
        self.telling.take(progress);
    }
}
