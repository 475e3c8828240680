//! The soft deadline of the current request, as the planner sees it. Only the processor time of the worker's process is
//! charged, so that a planner is not late merely because the machine did not schedule it. The console's own clock also
//! charges a planner for time in which it sleeps.

use super::Socket;
use super::progress_reporter::ProgressReporter;
use crate::Progress;
use crate::loader::Watch;
use crate::wire::frame::{Incoming, KIND_AT};
use crate::wire::kind;
use rustix::net::{RecvFlags, recv};
use rustix::time::{ClockId, clock_gettime};
use std::cell::Cell;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Minimum interval between two checks of the socket and of the processor time. Between requests, a process computes
/// nothing, so this is also the accuracy with which the processor time at the start of a request is known.
const CHECK_PERIOD: Duration = Duration::from_millis(1);

/// The deadline of a request, and whether a CANCEL has arrived after it.
pub(super) struct Deadline {
    socket: Socket,
    budget: Cell<Option<Budget>>,
    /// The time at which the processor time was last read before a request, and the value that was read.
    computed: Cell<(Instant, Duration)>,
    looked: Cell<Instant>,
    cancelled: Cell<bool>,
    exhausted: Cell<bool>,
    watched: Cell<bool>,
    progress: ProgressReporter,
}

/// The budget of a request. It is used up when the wall time and the processor time of this process have both reached
/// it.
#[derive(Debug, Clone, Copy)]
struct Budget {
    within: Duration,
    began: Instant,
    /// Processor time of this process at the start of the request.
    began_cpu: Duration,
}

impl Budget {
    fn left(&self, now: Instant) -> Duration {
        let computed = processor_time().saturating_sub(self.began_cpu);
        self.within.saturating_sub(computed.min(now - self.began))
    }

    fn is_used_up(&self, now: Instant) -> bool {
        // Reading the processor time costs a system call and is usually not needed.
        now - self.began >= self.within && self.left(now).is_zero()
    }
}

/// Processor time of all threads of this process.
fn processor_time() -> Duration {
    Duration::try_from(clock_gettime(ClockId::ProcessCPUTime)).unwrap_or_default()
}

impl Deadline {
    /// Creates the state before the first request.
    pub(super) fn new(socket: &Socket) -> Self {
        let now = Instant::now();
        Self {
            socket: Arc::clone(socket),
            budget: Cell::new(None),
            computed: Cell::new((now, processor_time())),
            looked: Cell::new(now),
            cancelled: Cell::new(false),
            exhausted: Cell::new(false),
            watched: Cell::new(false),
            progress: ProgressReporter::new(Arc::clone(socket)),
        }
    }

    /// Begins a request; anything that has already arrived after the request is a CANCEL.
    pub(super) fn begin(&self, request: &Incoming) {
        let now = Instant::now();
        // Reading the processor time costs a system call, and steps may come every few microseconds.
        if now - self.computed.get().0 >= CHECK_PERIOD {
            self.computed.set((now, processor_time()));
        }
        let (_, began_cpu) = self.computed.get();
        self.budget.set(request.soft_deadline().map(|within| Budget { within, began: now, began_cpu }));
        self.looked.set(now);
        self.cancelled.set(request.has_more());
        self.exhausted.set(false);
        self.progress.begin(request.kind(), request.sequence());
    }

    /// Sets whether drawings made during this request are shown.
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

impl Watch for Deadline {
    fn should_stop(&self) -> u32 {
        let now = Instant::now();
        self.progress.catch_up(now);
        if now - self.looked.get() >= CHECK_PERIOD {
            self.looked.set(now);
            self.cancelled.set(self.cancelled.get() || self.is_cancel_waiting());
            self.exhausted.set(self.budget.get().is_some_and(|budget| budget.is_used_up(now)));
        }
        match (self.cancelled.get(), self.exhausted.get()) {
            (true, _) => 1,
            (false, true) => 2,
            (false, false) => 0,
        }
    }

    fn time_left_s(&self) -> f64 {
        let left = self.budget.get().map(|budget| budget.left(Instant::now()));
        left.map_or(f64::INFINITY, |left| left.as_secs_f64())
    }

    fn wants_drawing(&self) -> bool {
        self.watched.get()
    }

    fn take_progress(&self, progress: Progress) {
        self.progress.take(progress);
    }
}
