//! What a worker is doing.

use crate::supervisor::clock::{FairClock, Load, Verdict};
use std::time::{Duration, Instant};

/// An unanswered request is first looked at after this time ...
const FIRST_LOOK: Duration = Duration::from_millis(100);
/// ... then at this interval ...
const LOOK_EVERY: Duration = Duration::from_millis(50);
/// ... and near the end of its budget no more often than this, which is the resolution of the processor time.
const LEAST_LOOK: Duration = Duration::from_millis(10);
/// A process whose socket is closed has ended or is about to.
const EXIT_WITHIN: Duration = Duration::from_millis(80);
/// A killed process ends at once unless the system is stuck.
pub(super) const DIE_WITHIN: Duration = Duration::from_millis(30);
/// What a dead process printed is in the pipe already.
const OUTPUT_WITHIN: Duration = Duration::from_millis(30);
/// Progress messages are forwarded at this rate, after an initial burst; the rest of a flood is dropped. A well-behaved
/// worker sends 20 a second.
const MOST_PER_S: f64 = 40.0;
const MOST_AT_FIRST: f64 = 20.0;

/// What a worker is doing.
pub(super) enum State {
    /// Nothing.
    Idle,
    /// It is asked.
    Busy(Request),
    /// Its budget is used up; until then it may still answer.
    Cancelling(Request, Instant),
    /// It is ending, and what can be learned about that is being gathered.
    Dying(Dying),
    /// It was asked to shut down and has until then to exit by itself. Without a time it was killed and is not reaped yet.
    Leaving(Option<Instant>),
    /// It has ended and was reaped.
    Gone,
}

/// A request without an answer.
pub(super) struct Request {
    pub(super) kind: u8,
    /// When it has to be looked at next.
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

    /// Looks at the process.
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

    /// Whether another progress message may be forwarded; if so, counts it.
    pub(super) fn may_forward(&mut self, now: Instant) -> bool {
        let elapsed_s = now.saturating_duration_since(self.began).as_secs_f64();
        let may = f64::from(self.n_forwarded) < MOST_AT_FIRST + MOST_PER_S * elapsed_s;
        self.n_forwarded += u32::from(may);
        may
    }
}

/// The end of a process that closed its channel.
pub(super) struct Dying {
    /// Whether it ends by our signal.
    pub(super) is_killed: bool,
    /// How long the next step of its end may take.
    pub(super) until: Instant,
}

impl Dying {
    /// It ends by itself, or has ended.
    pub(super) fn new(now: Instant) -> Self {
        Self { is_killed: false, until: now + EXIT_WITHIN }
    }

    /// It was killed.
    pub(super) fn wait_for_kill(&mut self, now: Instant) {
        (self.is_killed, self.until) = (true, now + DIE_WITHIN);
    }

    /// It was reaped.
    pub(super) fn wait_for_output(&mut self, now: Instant) {
        self.until = now + OUTPUT_WITHIN;
    }
}
