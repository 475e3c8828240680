//! The activities of a worker, with their time limits.

use crate::supervisor::clock::{FairClock, Load, Verdict};
use std::time::{Duration, Instant};

/// The time after a request at which a busy worker is first checked.
const FIRST_LOOK: Duration = Duration::from_millis(100);
/// The interval between later checks.
const LOOK_EVERY: Duration = Duration::from_millis(50);
/// The shortest interval between checks, used near the end of the worker's budget. It is the resolution of processor
/// time.
const LEAST_LOOK: Duration = Duration::from_millis(10);
/// Maximum time for a process to end after its socket is closed.
const EXIT_WITHIN: Duration = Duration::from_millis(80);
/// Maximum time for a killed process to end; if it takes longer, the system is stuck.
pub(super) const DIE_WITHIN: Duration = Duration::from_millis(30);
/// Maximum time to wait for the output of a dead process; the output is already in the pipe.
const OUTPUT_WITHIN: Duration = Duration::from_millis(30);
/// Maximum rate at which progress messages are forwarded after an initial burst, per second; further messages are
/// dropped. A well-behaved worker sends 20 a second.
const MOST_PER_S: f64 = 40.0;
const MOST_AT_FIRST: f64 = 20.0;

/// The current activity of a worker.
pub(super) enum State {
    /// Waiting for a request.
    Idle,
    /// Executing a request.
    Busy(Request),
    /// Out of budget; the worker may still answer until this time.
    Cancelling(Request, Instant),
    /// Ending, while its exit status and output are being collected.
    Dying(Dying),
    /// Asked to shut down, with this deadline for exiting. If there is no deadline, the worker was killed but has not
    /// been reaped yet.
    Leaving(Option<Instant>),
    /// Ended and reaped.
    Gone,
}

/// A request without an answer.
pub(super) struct Request {
    pub(super) kind: u8,
    /// When the worker must be checked next.
    pub(super) look_at: Instant,
    budget: Duration,
    began: Instant,
    clock: FairClock,
    n_forwarded: u32,
}

/// The state of a request's budget.
pub(super) enum Budgeted {
    Left,
    Exhausted,
    Starved,
}

impl Request {
    pub(super) fn new(kind: u8, budget: Duration, now: Instant) -> Self {
        let look_at = now + budget.min(FIRST_LOOK);
        Self { kind, look_at, budget, began: now, clock: FairClock::default(), n_forwarded: 0 }
    }

    /// Checks the load of the process, and how much of the budget is left.
    pub(super) fn look(&mut self, now: Instant, load: Option<Load>) -> Budgeted {
        self.clock.advance(now.saturating_duration_since(self.began), load);
        match self.clock.evaluate(self.budget) {
            Verdict::Left(left) => {
                self.look_at = now + left.clamp(LEAST_LOOK, LOOK_EVERY);
                Budgeted::Left
            }
            Verdict::Exhausted => Budgeted::Exhausted,
            Verdict::Starved => Budgeted::Starved,
        }
    }

    /// Whether one more progress message may be forwarded; if so, counts it.
    pub(super) fn may_forward(&mut self, now: Instant) -> bool {
        let elapsed_s = now.saturating_duration_since(self.began).as_secs_f64();
        let may = f64::from(self.n_forwarded) < MOST_AT_FIRST + MOST_PER_S * elapsed_s;
        self.n_forwarded += u32::from(may);
        may
    }
}

/// A process that closed its channel and is ending.
pub(super) struct Dying {
    /// Whether the console killed the process.
    pub(super) is_killed: bool,
    /// The deadline for the next step of its end.
    pub(super) until: Instant,
}

impl Dying {
    /// Creates the state of a process that is ending on its own or has ended.
    pub(super) fn new(now: Instant) -> Self {
        Self { is_killed: false, until: now + EXIT_WITHIN }
    }

    /// Sets the deadline for the end of a process that was killed.
    pub(super) fn wait_for_kill(&mut self, now: Instant) {
        (self.is_killed, self.until) = (true, now + DIE_WITHIN);
    }

    /// Sets the deadline for the output of a process that was reaped.
    pub(super) fn wait_for_output(&mut self, now: Instant) {
        self.until = now + OUTPUT_WITHIN;
    }
}
