//! The sources of the planners' answers, and how long a tick waits for them.
//!
//! The mission itself never waits. In a headless flight, every ask is answered before mission time advances, in the order
//! of the asks, so the result does not depend on the machine. The console gives each tick a time window and continues
//! without answers that are late.

use mission::{Answer, Ask, AskId, Awaits, Mission, What};
use planner_host::Host;
use std::{
    collections::VecDeque,
    time::{Duration, Instant},
};

/// A source of answers to the asks of a mission.
pub trait Answers {
    /// Takes an ask from the mission.
    fn submit(&mut self, ask: Ask);

    /// The next answer for the current tick of a mission; `None` if the tick should end.
    fn next(&mut self, mission: &Mission) -> Option<Answer>;
}

/// Waits for every answer, and returns the answers in the order of the asks. If a [`planner_host::Waker`] interrupts a
/// tick, the asks of that tick stay open for the next one.
pub struct InOrder {
    host: Host,
    /// Asks that have no answer yet, oldest first.
    open: VecDeque<AskId>,
    /// Answers that arrived before the answers to older asks.
    early: Vec<Answer>,
}

impl InOrder {
    /// Creates the source from a host; from now on only this thread uses that host.
    pub fn new(mut host: Host) -> Self {
        host.share_processor();
        Self { host, open: VecDeque::new(), early: Vec::new() }
    }

    /// The host.
    pub fn host(&mut self) -> &mut Host {
        &mut self.host
    }

    /// Ends a mission. The next one starts as it would with a new host, except that planner processes may be reused.
    pub fn end_mission(&mut self) {
        self.host.end_mission();
        self.open.clear();
        self.early.clear();
    }

    /// Returns the host after the flight.
    pub fn into_host(self) -> Host {
        self.host
    }
}

impl Answers for InOrder {
    fn submit(&mut self, ask: Ask) {
        if ask.what == What::Close {
            self.open.retain(|open| open.worker != ask.id.worker);
            self.early.retain(|early| early.ask.worker != ask.id.worker);
        } else {
            self.open.push_back(ask.id);
        }
        self.host.submit(ask);
    }

    fn next(&mut self, _: &Mission) -> Option<Answer> {
        loop {
            let oldest = *self.open.front()?;
            if let Some(at) = self.early.iter().position(|answer| answer.ask == oldest) {
                self.open.pop_front();
                return Some(self.early.swap_remove(at));
            }
            self.early.push(self.host.next(None)?);
        }
    }
}

/// Gives each tick a time window; an answer that comes later is used in a later tick.
pub struct Windowed<'a> {
    host: &'a mut Host,
    /// How long a tick waits for the robot's command; `None` means no limit.
    step: Option<Duration>,
    /// How long a tick waits for an answer for which the robot stands still.
    work: Duration,
    /// How long a tick waits if the only open ask is to the planner in shadow.
    shadow: Duration,
    began: Instant,
}

impl<'a> Windowed<'a> {
    /// Starts the window for a tick that begins now.
    pub fn new(host: &'a mut Host, window: Window) -> Self {
        let Window { step, work, shadow } = window;
        Self { host, step, work, shadow, began: Instant::now() }
    }
}

impl Answers for Windowed<'_> {
    fn submit(&mut self, ask: Ask) {
        self.host.submit(ask);
    }

    fn next(&mut self, mission: &Mission) -> Option<Answer> {
        let until = match mission.awaits() {
            Awaits::Step => self.step.map(|window| self.began + window),
            Awaits::Work => Some(self.began + self.work),
            Awaits::Shadow => Some(self.began + self.shadow),
            // Answers that have already arrived are used; the tick does not wait for any others.
            Awaits::Candidate | Awaits::Nothing => Some(self.began),
        };
        self.host.next(until)
    }
}

/// How long a tick waits for answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// How long a tick waits for the robot's command; `None` means no limit.
    pub step: Option<Duration>,
    /// How long a tick waits for a planner to be opened, or for a plan, while the robot stands still.
    pub work: Duration,
    /// How long a tick waits for the planner in shadow, if no other planner has an open ask. In real time, this is
    /// zero: the planner can answer until the next tick.
    pub shadow: Duration,
}

/// Share of a tick that is available for waiting.
const SHARE: f64 = 0.6;
/// Minimum wait in a simulation that runs faster than real time: the simulation slows down rather than letting the robot
/// stop.
const AT_LEAST: Duration = Duration::from_millis(100);

impl Window {
    /// Windows for real time.
    pub fn real_time(tick: Duration) -> Self {
        let share = tick.mul_f64(SHARE);
        Self { step: Some(share), work: share, shadow: Duration::ZERO }
    }

    /// Windows for a simulation that runs faster than real time.
    pub fn faster(tick: Duration) -> Self {
        let real_time = Self::real_time(tick);
        Self { step: Some(real_time.work.max(AT_LEAST)), shadow: AT_LEAST, ..real_time }
    }

    /// Windows for a simulation at maximum speed.
    pub fn unbounded(tick: Duration) -> Self {
        Self { step: None, shadow: AT_LEAST, ..Self::real_time(tick) }
    }
}
