//! One flight, as fast as it goes.

use crate::tape::Taping;
use account::{Fold, Summary};
use flight::{Flight, hosts};
use mission::{Cause, Event, EventKind, Fault, Order, Outcome, Parameters, Phase, PlannerChoice};
use planner_api::Code;
use planner_host::{Host, PluginDirs};
use scenario::Scenario;

/// What came of a flight.
#[derive(Debug)]
pub(crate) struct Flown {
    pub(crate) summary: Summary,
    /// Median time for a step, milliseconds by the wall clock; absent without steps.
    pub(crate) p50_ms: Option<f64>,
    /// Time that 99 of 100 steps do not exceed.
    pub(crate) p99_ms: Option<f64>,
    /// Memory that its process had at most, bytes; absent where the system does not say.
    pub(crate) memory_bytes: Option<u64>,
    /// Threads that were left between its last calls; absent where the system does not say.
    pub(crate) threads_left: Option<u32>,
    /// How it ended when it was not wanted any more, if not well.
    pub(crate) bad_end: Option<String>,
    /// First fault that no good planner has.
    pub(crate) misbehaved: Option<String>,
    /// First time that it said no.
    pub(crate) gave_up: Option<String>,
    /// It said that it does not fly such missions.
    pub(crate) unsupported: bool,
}

impl Flown {
    pub(crate) fn is_complete(&self) -> bool {
        self.summary.outcome == Some(Outcome::Complete)
    }
}

/// The memory of planners is looked at every so many ticks.
const LOOK_AT_MEMORY_EVERY: u64 = 16;

/// So many looks in a row must find a thread for it to count as left.
const LOOKS: usize = 3;
/// Threads that every worker has.
const OWN_THREADS: u32 = 2;

/// A flight that goes on until its mission ends, or somebody stops looking.
pub(crate) struct Pilot {
    /// Whose faults are looked for.
    planner: String,
    flight: Flight,
    answers: Taping,
    fold: Fold,
    memory_bytes: Option<u64>,
    /// Threads that its process had at the last looks, newest first.
    threads: [u32; LOOKS],
    misbehaved: Option<String>,
    gave_up: Option<String>,
    /// First failure of another planner than that one.
    failed_beside: bool,
    unsupported: bool,
    tick: u64,
}

/// A tank, to be flown by this planner.
pub(crate) fn with_planner(tank: &Scenario, id: &str, parameters: Parameters) -> Scenario {
    let mut scenario = tank.clone();
    scenario.mission.planner = PlannerChoice { id: id.to_owned(), parameters };
    scenario
}

/// Flies a tank with a planner to the end.
pub(crate) fn fly(tank: &Scenario, id: &str, plugins: &PluginDirs) -> Flown {
    let mut pilot = Pilot::new(id, &with_planner(tank, id, Parameters::new()), plugins, false);
    while pilot.tick(&[]).is_some() {}
    pilot.land()
}

impl Pilot {
    /// Ready to start, and to look for faults of this planner; with an operator a hold does not end the mission.
    pub(crate) fn new(planner: &str, scenario: &Scenario, plugins: &PluginDirs, attended: bool) -> Self {
        let flight = Flight::prepare(scenario, attended);
        let host = Host::new(plugins, hosts::config(&scenario.mission));
        let mut fold = Fold::new();
        fold.apply(&flight.opened());
        Self {
            planner: planner.to_owned(),
            flight,
            answers: Taping::new(host),
            fold,
            memory_bytes: None,
            threads: [0; LOOKS],
            misbehaved: None,
            gave_up: None,
            failed_beside: false,
            unsupported: false,
            tick: 0,
        }
    }

    /// Flies one tick with these orders; its events, or none when the mission has ended.
    pub(crate) fn tick(&mut self, orders: &[Order]) -> Option<Vec<Event>> {
        if matches!(self.flight.phase(), Phase::Ended(_)) {
            return None;
        }
        let start = [Order::Start];
        let events = self.flight.tick(if self.tick == 0 { &start } else { orders }, &mut self.answers);
        if self.tick.is_multiple_of(LOOK_AT_MEMORY_EVERY) {
            self.look_at_process();
        }
        self.tick += 1;
        for event in &events {
            self.fold.apply(event);
            if let EventKind::PlannerFailed { fault, .. } = &event.kind {
                self.note(fault);
            }
        }
        Some(events)
    }

    fn note(&mut self, fault: &Fault) {
        if fault.planner != self.planner {
            self.failed_beside = true;
            return;
        }
        self.unsupported |= fault.cause == Cause::Planner(Code::Unsupported);
        let first = match fault.cause {
            Cause::Planner(_) => &mut self.gave_up,
            Cause::Quarantined => return,
            _ => &mut self.misbehaved,
        };
        first.get_or_insert_with(|| fault.message.clone());
    }

    fn look_at_process(&mut self) {
        let memory = self.answers.memory();
        self.memory_bytes = memory.map(|memory| memory.most_bytes).max(self.memory_bytes);
        self.threads.rotate_right(1);
        self.threads[0] = memory.map_or(0, |memory| memory.threads);
    }

    /// Whether another planner failed.
    pub(crate) fn failed_beside(&self) -> bool {
        self.failed_beside
    }

    /// First fault that no good planner has.
    pub(crate) fn misbehaved(&self) -> Option<&str> {
        self.misbehaved.as_deref()
    }

    /// What the planners were asked first.
    pub(crate) fn into_tape(self) -> Vec<mission::What> {
        self.answers.into_tape()
    }

    fn land(mut self) -> Flown {
        let calls = hosts::calls(self.answers.host());
        // A thread that has just ended may still be counted.
        let threads = self.threads.into_iter().min().unwrap_or_default();
        self.answers.host().finish();
        let bad_end = self.answers.host().take_bad_ends().into_iter().next();
        Flown {
            summary: self.fold.summary(),
            p50_ms: calls.p50_us.map(|us| us / 1000.0),
            p99_ms: calls.p99_us.map(|us| us / 1000.0),
            memory_bytes: self.memory_bytes,
            threads_left: threads.checked_sub(OWN_THREADS).filter(|left| *left > 0),
            bad_end: bad_end.map(|end| end.to_string()),
            misbehaved: self.misbehaved,
            gave_up: self.gave_up,
            unsupported: self.unsupported,
        }
    }
}
