//! Where the answers of planners come from, and how long a tick waits for them.
//!
//! The mission itself never waits. A headless flight answers every ask before time moves on, in the order of the asks, so
//! that it does not depend on the machine; the console gives each tick a time window and continues without late answers.

use mission::{Answer, Ask, AskId, Awaits, Mission, What};
use planner_host::Host;
use std::{
    collections::VecDeque,
    time::{Duration, Instant},
};

/// Answers asks of a mission.
pub trait Answers {
    /// Takes an ask.
    fn submit(&mut self, ask: Ask);

    /// The next answer that is to enter this tick of a mission; `None` when the tick is to end.
    fn next(&mut self, mission: &Mission) -> Option<Answer>;
}

/// Waits for every answer, and gives them in the order of the asks. A tick that a [`planner_host::Waker`] interrupts
/// leaves its asks open for the next one.
pub struct InOrder {
    host: Host,
    /// Asks without an answer, oldest first.
    open: VecDeque<AskId>,
    /// Answers that came before older ones.
    early: Vec<Answer>,
}

impl InOrder {
    /// The answers of a host, which from now on is asked by this thread alone.
    pub fn new(mut host: Host) -> Self {
        host.share_processor();
        Self { host, open: VecDeque::new(), early: Vec::new() }
    }

    /// The host.
    pub fn host(&mut self) -> &mut Host {
        &mut self.host
    }

    /// Ends a mission; the next one begins as with a new host, but for the processes of its planners.
    pub fn end_mission(&mut self) {
        self.host.end_mission();
        self.open.clear();
        self.early.clear();
    }

    /// The host, after the flight.
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

/// Gives each tick a window; what comes later enters a later tick.
pub struct Windowed<'a> {
    host: &'a mut Host,
    /// How long a tick waits for the command of the robot; `None` for as long as it takes.
    step: Option<Duration>,
    /// How long a tick waits for work that the robot stands for.
    work: Duration,
    /// How long a tick waits for the planner in shadow alone.
    shadow: Duration,
    began: Instant,
}

impl<'a> Windowed<'a> {
    /// For the tick that begins now.
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
            // What is there already enters; nobody waits for the rest.
            Awaits::Candidate | Awaits::Nothing => Some(self.began),
        };
        self.host.next(until)
    }
}

/// How long a tick waits for answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// For the command of the robot; `None` for as long as it takes.
    pub step: Option<Duration>,
    /// For opening a planner or making a plan, for which the robot stands.
    pub work: Duration,
    /// For the planner in shadow, when nothing else is asked. At the pace of the clock nobody waits for it: it has the time
    /// until the next tick.
    pub shadow: Duration,
}

/// Share of a tick that is left for answers.
const SHARE: f64 = 0.6;
/// A simulation that runs faster than the clock waits this long at least: its pace slips before the robot stands still.
const AT_LEAST: Duration = Duration::from_millis(100);

impl Window {
    /// At the pace of the clock.
    pub fn real_time(tick: Duration) -> Self {
        let share = tick.mul_f64(SHARE);
        Self { step: Some(share), work: share, shadow: Duration::ZERO }
    }

    /// Faster than the clock.
    pub fn faster(tick: Duration) -> Self {
        let real_time = Self::real_time(tick);
        Self { step: Some(real_time.work.max(AT_LEAST)), shadow: AT_LEAST, ..real_time }
    }

    /// As fast as it goes.
    pub fn unbounded(tick: Duration) -> Self {
        Self { step: None, shadow: AT_LEAST, ..Self::real_time(tick) }
    }
}
