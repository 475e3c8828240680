//! Runs one mission as fast as possible.

use crate::tape::Taping;
use account::{Fold, Summary};
use flight::{Flight, hosts};
use mission::{Cause, Event, EventKind, Fault, Order, Outcome, Parameters, Phase, PlannerChoice};
use planner_api::Code;
use planner_host::{Host, PluginDirs};
use scenario::Scenario;

/// The result of a mission.
#[derive(Debug)]
pub(crate) struct Flown {
    pub(crate) summary: Summary,
    /// Median wall time of a step, milliseconds; absent without steps.
    pub(crate) p50_ms: Option<f64>,
    /// 99th percentile of the wall time of a step, milliseconds; absent without steps.
    pub(crate) p99_ms: Option<f64>,
    /// Peak memory of the planner's process, bytes; absent where the system does not report it.
    pub(crate) memory_bytes: Option<u64>,
    /// The number of threads left running between the last calls; absent if there were none or the system does not
    /// report it.
    pub(crate) threads_left: Option<u32>,
    /// The fault with which the planner ended; absent if it ended cleanly.
    pub(crate) bad_end: Option<String>,
    /// The first fault of a kind that a correct planner never has.
    pub(crate) misbehaved: Option<String>,
    /// The planner's first refusal.
    pub(crate) gave_up: Option<String>,
    /// Whether the planner reported that it does not support such missions.
    pub(crate) unsupported: bool,
}

impl Flown {
    pub(crate) fn is_complete(&self) -> bool {
        self.summary.outcome == Some(Outcome::Complete)
    }
}

/// The planner's memory is measured at this interval, ticks.
const LOOK_AT_MEMORY_EVERY: u64 = 16;

/// The number of consecutive measurements that must find a thread for it to count as left running.
const LOOKS: usize = 3;
/// The number of threads that every worker has.
const OWN_THREADS: u32 = 2;

/// A mission that runs until it ends or the caller stops.
pub(crate) struct Pilot {
    /// The planner whose faults are recorded.
    planner: String,
    flight: Flight,
    answers: Taping,
    fold: Fold,
    memory_bytes: Option<u64>,
    /// The number of threads in the process at the last measurements, newest first.
    threads: [u32; LOOKS],
    faults: Faults,
    tick: u64,
}

/// The faults in a mission, by what they mean for the planner under test.
#[derive(Debug, Default, PartialEq)]
struct Faults {
    /// The first fault of a kind that a correct planner never has.
    misbehaved: Option<String>,
    /// The planner's first refusal.
    gave_up: Option<String>,
    /// Whether a different planner failed.
    beside: bool,
    /// Whether the planner reported that it does not support such missions.
    unsupported: bool,
}

impl Faults {
    fn note(&mut self, planner: &str, fault: &Fault) {
        if fault.planner != planner {
            self.beside = true;
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
}

/// Returns the scenario of a tank with this planner.
pub(crate) fn with_planner(tank: &Scenario, id: &str, parameters: Parameters) -> Scenario {
    let mut scenario = tank.clone();
    scenario.mission.planner = PlannerChoice { id: id.to_owned(), parameters };
    scenario
}

/// Runs the mission in a tank with a planner until the mission ends.
pub(crate) fn fly(tank: &Scenario, id: &str, plugins: &PluginDirs) -> Flown {
    let mut pilot = Pilot::new(id, &with_planner(tank, id, Parameters::new()), plugins, false);
    while pilot.tick(&[]).is_some() {}
    pilot.land()
}

impl Pilot {
    /// Prepares a mission and records faults of this planner. If the mission is `attended`, a hold does not end it.
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
            faults: Faults::default(),
            tick: 0,
        }
    }

    /// Runs one tick with these orders. Returns the events, or `None` when the mission has ended.
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
                self.faults.note(&self.planner, fault);
            }
        }
        Some(events)
    }

    fn look_at_process(&mut self) {
        let memory = self.answers.memory();
        self.memory_bytes = memory.map(|memory| memory.most_bytes).max(self.memory_bytes);
        self.threads.rotate_right(1);
        self.threads[0] = memory.map_or(0, |memory| memory.threads);
    }

    /// Whether a different planner failed.
    pub(crate) fn failed_beside(&self) -> bool {
        self.faults.beside
    }

    /// Returns the first fault of a kind that a correct planner never has.
    pub(crate) fn misbehaved(&self) -> Option<&str> {
        self.faults.misbehaved.as_deref()
    }

    /// Returns the first requests to the planner.
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
            misbehaved: self.faults.misbehaved,
            gave_up: self.faults.gave_up,
            unsupported: self.faults.unsupported,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mission::During;

    fn fault(planner: &str, cause: Cause) -> Fault {
        Fault {
            planner: planner.into(),
            during: During::Step,
            cause,
            message: format!("planner {planner}: {cause}"),
            partial: Vec::new(),
            plugin_sha256: None,
        }
    }

    fn noted(faults: &[Fault]) -> Faults {
        let mut noted = Faults::default();
        for fault in faults {
            noted.note("own", fault);
        }
        noted
    }

    #[test]
    fn a_refusal_is_no_misbehaviour_and_the_first_of_each_counts() {
        let no_path = Cause::Planner(Code::NoPath);
        let all = [fault("own", no_path), fault("own", Cause::Panic), fault("own", Cause::Hung)];
        let expected = Faults {
            misbehaved: Some("planner own: panic".into()),
            gave_up: Some("planner own: the planner reports: no path found".into()),
            ..Faults::default()
        };
        assert_eq!(noted(&all), expected);
    }

    #[test]
    fn a_mission_that_the_planner_does_not_fly_is_told_from_one_that_it_gives_up() {
        let unsupported = noted(&[fault("own", Cause::Planner(Code::Unsupported))]);
        assert!(unsupported.unsupported && unsupported.gave_up.is_some() && unsupported.misbehaved.is_none());
    }

    #[test]
    fn faults_of_others_and_the_quarantine_that_follows_a_fault_are_not_its_own() {
        let others = noted(&[fault("other", Cause::Panic), fault("own", Cause::Quarantined)]);
        assert_eq!(others, Faults { beside: true, ..Faults::default() });
    }
}
