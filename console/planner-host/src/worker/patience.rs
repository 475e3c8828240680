//! How long the console waits for the request at hand.

use crate::loader::Watch;
use crate::wire::frame::KIND_AT;
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
}

impl Patience {
    /// No request yet.
    pub(super) fn new(socket: OwnedFd) -> Self {
        Self {
            socket,
            deadline: Cell::new(None),
            peeked: Cell::new(Instant::now()),
            cancelled: Cell::new(false),
            watched: Cell::new(false),
        }
    }

    /// A request arrived with this soft deadline; only a CANCEL can have arrived behind it.
    pub(super) fn begin(&self, soft_deadline: Option<Duration>, is_cancelled: bool) {
        let now = Instant::now();
        self.deadline.set(soft_deadline.and_then(|within| now.checked_add(within)));
        self.peeked.set(now);
        self.cancelled.set(is_cancelled);
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
}
