//! Answers the mission's asks: finds, starts, asks and ends planners, and waits only in [`Host::next`].

mod config;
pub(crate) mod fault;
mod find;
mod kept;
mod leaving;
mod opening;
mod planner;
mod said_limit;
mod saved;
mod spare;
#[cfg(target_os = "linux")]
mod together;

pub use config::HostConfig;
pub(crate) use opening::Opening;
pub(crate) use planner::Wanted;

use crate::OnProgress;
use crate::discovery::PluginDirs;
use crate::remains::{BadEnd, Crash, Printed, is_crash};
use crate::stats::{Durations, HostStats, Memory};
use crate::supervisor::{Failure, Ready, WakeReceiver, Waker, Worker, wait};
use find::Catalog;
use kept::Kept;
use leaving::Leaving;
use mission::{Answer, Ask, AskId, Fault, Given, Said, What, WorkerId};
use planner::{Asked, Doing, Outcome, Planner};
use saved::SavedStates;
use spare::Spares;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Runs planners for missions, each in a worker process.
///
/// [`Self::submit`] begins an ask and returns immediately. [`Self::next`] returns the answers and is the only function
/// that waits. Every ask except [`What::Close`] is answered exactly once, unless its worker is closed first.
///
/// A timeout, a crash, a panic or an invalid answer ends the process, and the planner must be opened again.
pub struct Host {
    config: HostConfig,
    catalog: Catalog,
    planners: Vec<Planner>,
    /// Retired workers that are still running.
    leaving: Vec<Leaving>,
    answers: VecDeque<Answer>,
    /// The events of each worker from the last poll; the list is kept only so that its memory can be reused.
    ready: Vec<Ready>,
    saved: SavedStates,
    spares: Spares,
    wake_ups: WakeReceiver,
    plan_times: Durations,
    step_times: Durations,
    n_faults: u64,
    on_progress: Option<OnProgress>,
    kept: Kept,
    /// The last requests and output of a worker that failed while its planner was being opened.
    remains: Option<(Vec<u8>, String)>,
    #[cfg(target_os = "linux")]
    together: Option<together::Together>,
}

impl Host {
    /// Creates a host that searches these folders when the first planner is opened.
    pub fn new(dirs: &PluginDirs, config: HostConfig) -> Self {
        Self {
            config,
            catalog: Catalog::new(dirs.clone()),
            planners: Vec::new(),
            leaving: Vec::new(),
            answers: VecDeque::new(),
            ready: Vec::new(),
            saved: SavedStates::default(),
            spares: Spares::default(),
            wake_ups: WakeReceiver::new(),
            plan_times: Durations::default(),
            step_times: Durations::default(),
            n_faults: 0,
            on_progress: None,
            kept: Kept::default(),
            remains: None,
            #[cfg(target_os = "linux")]
            together: None,
        }
    }

    /// From now on, runs a planner on the processor of the calling thread if it is the only planner. Call this from a
    /// thread that waits for every command.
    pub fn share_processor(&mut self) {
        #[cfg(target_os = "linux")]
        {
            self.together = Some(together::Together::new());
        }
    }

    /// Moves a planner to the processor of this thread for a command, and away from that processor for everything else.
    #[cfg_attr(
        not(target_os = "linux"),
        allow(unused_variables, clippy::unused_self, reason = "only possible on Linux")
    )]
    fn place(&mut self, wanted: Option<&Wanted<'_>>) {
        #[cfg(target_os = "linux")]
        if let Some(together) = &mut self.together {
            match (wanted, &self.planners[..]) {
                (Some(Wanted::Step(_)), [Planner { worker: Some(worker), .. }]) => together.gather(worker),
                (_, planners) => together.part(planners.iter().filter_map(|planner| planner.worker.as_ref())),
            }
        }
    }

    /// Sets the callback that receives the progress of plans while they are being computed.
    pub fn set_on_progress(&mut self, on_progress: OnProgress) {
        self.on_progress = Some(on_progress);
    }

    /// Returns what planners have printed since the last call.
    pub fn take_printed(&mut self) -> Vec<Printed> {
        std::mem::take(&mut self.kept.printed)
    }

    /// Returns the remains of the planners that have failed since the last call.
    pub fn take_crashes(&mut self) -> Vec<Crash> {
        std::mem::take(&mut self.kept.crashes)
    }

    /// Returns the planners that have ended badly since the last call.
    pub fn take_bad_ends(&mut self) -> Vec<BadEnd> {
        std::mem::take(&mut self.kept.bad_ends)
    }

    /// Returns the budget for a plan.
    pub fn plan_budget(&self) -> Duration {
        self.config.plan_deadline
    }

    /// Returns the number of calls, their wall times and the number of faults so far.
    pub fn stats(&self) -> HostStats {
        HostStats { plan: self.plan_times.stats(), step: self.step_times.stats(), faults: self.n_faults }
    }

    /// Returns the memory of a planner's process; `None` if it has ended or the system does not report it.
    pub fn memory(&self, id: WorkerId) -> Option<Memory> {
        self.planners.iter().find(|planner| planner.id == id)?.worker.as_ref()?.memory()
    }

    /// Returns a waker that makes [`Self::next`] return from any thread.
    pub fn waker(&self) -> Waker {
        self.wake_ups.waker()
    }

    /// Drops pending wake-ups.
    pub fn clear_wake_ups(&mut self) {
        self.wake_ups.take();
    }

    /// Ends a mission, so that the next mission begins as it would with a new host. Only processes are reused: a
    /// planner that has answered all its asks is created again, when it is next opened, in the process that loaded it.
    pub fn end_mission(&mut self) {
        self.place(None);
        for planner in std::mem::take(&mut self.planners) {
            let name = planner.name().to_owned();
            let Some(worker) = planner.worker else { continue };
            let surplus = match planner.ready {
                Some(ready) if worker.is_idle() => self.spares.keep(worker, ready.loaded),
                _ => Some(worker),
            };
            if let Some(worker) = surplus {
                self.dismiss(&name, worker);
            }
        }
        self.answers.clear();
        self.kept = Kept::default();
        self.remains = None;
        self.saved = SavedStates::default();
        (self.plan_times, self.step_times, self.n_faults) = Default::default();
    }

    /// Begins an ask. A worker with an open ask accepts only [`What::Close`].
    pub fn submit(&mut self, ask: Ask) {
        let id = ask.id;
        match ask.what {
            What::Open { choice, site, restore } => {
                self.place(None);
                let opening = site.lend(|site| Opening::new(&choice.id, &choice.parameters, site, restore));
                self.open(id, opening);
            }
            What::Reconfigure(values) => self.begin(id, &Wanted::Reconfigure(&values)),
            What::Plan(plan) => plan.lend(|request| self.begin(id, &Wanted::Plan(request))),
            What::Step(step) => step.lend(|sensed| self.begin(id, &Wanted::Step(sensed))),
            What::Snapshot => self.begin(id, &Wanted::Snapshot),
            What::Close => self.close(id.worker),
        }
    }

    /// Begins an ask to an opened planner; an ask that cannot begin is answered immediately.
    pub(crate) fn begin(&mut self, id: AskId, wanted: &Wanted<'_>) {
        if let Err(fault) = self.try_begin(id, wanted) {
            self.answer(id, Err(fault));
        }
    }

    fn try_begin(&mut self, id: AskId, wanted: &Wanted<'_>) -> Result<(), Fault> {
        self.place(Some(wanted));
        let config = &self.config;
        let Some(planner) = self.planners.iter_mut().find(|planner| planner.id == id.worker) else {
            return Err(fault::of(Failure::Gone, "", wanted.phase()));
        };
        if planner.asked.is_some() {
            return Err(planner.busy(wanted.phase()));
        }
        match wanted {
            Wanted::Reconfigure(values) => planner.reconfigure(id, values, config),
            Wanted::Plan(request) => planner.plan(id, request, config),
            Wanted::Step(sensed) => planner.step(id, sensed, config),
            Wanted::Snapshot if planner.saves_state() => {
                planner.check_alive()?;
                planner.snapshot(id, config)
            }
            Wanted::Snapshot => {
                planner.check_alive()?;
                self.answer(id, Ok((Given::State { bytes: 0 }, Said::default())));
                Ok(())
            }
        }
    }

    /// Returns the next answer as soon as there is one, or `None` when the time limit is reached, when the host was
    /// woken, or when no ask is open. Without a time limit, waits indefinitely. Messages that have already arrived are
    /// always processed.
    pub fn next(&mut self, until: Option<Instant>) -> Option<Answer> {
        if self.answers.is_empty() && self.leaving.is_empty() && !self.is_asked() {
            self.clear_wake_ups();
            return None;
        }
        loop {
            let may_wait = self.answers.is_empty() && self.is_asked();
            if self.look(if may_wait { until } else { Some(Instant::now()) }) {
                return None;
            }
            if let Some(answer) = self.answers.pop_front() {
                return Some(answer);
            }
            if !self.is_asked() || until.is_some_and(|until| Instant::now() >= until) {
                return None;
            }
        }
    }

    /// Waits until something happens, until the time limit is reached or until the host is woken, and processes what has
    /// arrived. Answers are left for [`Self::next`].
    ///
    /// Call this between the ticks of a mission: a planner that is being opened needs a decision on each of its system
    /// calls, and goes on from stage to stage. Does nothing if no ask is open.
    pub fn attend(&mut self, until: Instant) {
        if self.is_asked() {
            self.look(Some(until));
        }
    }

    /// Whether a planner still owes an answer.
    pub fn is_asked(&self) -> bool {
        self.planners.iter().any(|planner| planner.asked.is_some())
    }

    /// Whether the process of a planner has ended although the planner was asked for nothing. The next [`What::Snapshot`]
    /// returns the reason.
    pub fn has_ended_idle(&mut self, id: WorkerId) -> bool {
        self.planners.iter_mut().any(|planner| planner.id == id && planner.has_ended_idle())
    }

    /// Waits until something happens or the time limit is reached, and then handles the events. Returns whether
    /// the host was woken.
    fn look(&mut self, until: Option<Instant>) -> bool {
        if self.is_answered_at_once() {
            return false;
        }
        let asked = self.planners.iter().filter_map(|planner| planner.worker.as_ref());
        let leaving = self.leaving.iter().map(|leaving| &leaving.worker);
        let woken = wait(Some(&self.wake_ups), asked.chain(leaving), until, &mut self.ready);
        self.go_on();
        woken
    }

    /// Whether a planner on the processor of this thread has answered. The planner has usually answered by the time
    /// this thread runs again; the system is then asked for other events only once a millisecond.
    fn is_answered_at_once(&mut self) -> bool {
        #[cfg(target_os = "linux")]
        if let (Some(together), [_], true) = (&mut self.together, &self.planners[..], self.leaving.is_empty())
            && together.may_look_later()
        {
            self.ready.clear();
            self.ready.push(Ready::PERHAPS_ANSWERED);
            self.go_on();
            return !self.answers.is_empty();
        }
        false
    }

    /// Handles the replies and failures of workers.
    fn go_on(&mut self) {
        let (now, mut ready) = (Instant::now(), self.ready.iter().copied());
        let mut outcomes = Vec::new();
        for planner in &mut self.planners {
            let Some(worker) = &mut planner.worker else { continue };
            let Some(ready) = ready.next() else { break };
            let (asked, on_progress) = (planner.asked.as_ref(), self.on_progress.as_ref());
            let forward = &mut |progress: &_| {
                if let Some((asked, on_progress)) = asked.zip(on_progress) {
                    on_progress(asked.id, progress);
                }
            };
            outcomes.extend(worker.advance(ready, now, forward).map(|outcome| (planner.id, outcome)));
            let lines = worker.take_printed();
            self.kept.note_printed(planner.name(), lines);
        }
        let ready: Vec<Ready> = ready.collect();
        self.advance_leaving(&ready, now);
        for (id, outcome) in outcomes {
            self.take(id, outcome);
        }
    }

    /// Processes the outcome of a worker's request.
    fn take(&mut self, id: WorkerId, outcome: Result<(), Failure>) {
        let Some(planner) = self.planners.iter_mut().find(|planner| planner.id == id) else { return };
        let Some(Asked { id, at, doing }) = planner.asked.take() else { return };
        let outcome = match doing {
            Doing::Open(opening, stage) => return self.go_on_opening(id, *opening, *stage, outcome),
            Doing::Reconfigure(values) => planner.reconfigured(outcome, values),
            Doing::Plan(limits) => {
                self.plan_times.note(at.elapsed());
                planner.planned(outcome, limits)
            }
            Doing::Step(tick) => {
                self.step_times.note(at.elapsed());
                planner.stepped(outcome, tick)
            }
            Doing::Snapshot => planner.snapshotted(outcome).map(|saved| {
                let bytes = saved.as_ref().map_or(0, |state| state.len() as u64);
                if let Some((state, ready)) = saved.zip(planner.ready.as_ref()) {
                    self.saved.keep(ready.loaded.saved(id, state));
                }
                (Given::State { bytes }, Said::default())
            }),
        };
        self.answer(id, outcome);
    }

    /// Queues an answer for [`Self::next`].
    fn answer(&mut self, ask: AskId, outcome: Outcome) {
        self.n_faults += u64::from(outcome.is_err());
        let (result, said) = match outcome {
            Ok((given, said)) => (Ok(given), said),
            Err(fault) => (Err(fault), Said::default()),
        };
        if let Err(fault) = &result {
            self.keep_remains(ask.worker, fault);
            self.retire(ask.worker);
        }
        self.answers.push_back(Answer { ask, result, said });
    }

    /// Keeps the remains of a planner if the author must find out why the planner failed.
    fn keep_remains(&mut self, id: WorkerId, fault: &Fault) {
        let planner = self.planners.iter_mut().find(|planner| planner.id == id);
        let of_worker = planner.and_then(|planner| planner.worker.as_mut()).map(Worker::remains);
        let remains = of_worker.or(self.remains.take());
        if let Some((frames, output)) = remains.filter(|_| is_crash(fault.cause)) {
            self.kept.note_crash(Crash { fault: fault.clone(), frames, output });
        }
    }
}

impl Drop for Host {
    /// Kills all workers at once, then reaps them.
    fn drop(&mut self) {
        let asked = self.planners.iter_mut().filter_map(|planner| planner.worker.as_mut());
        let leaving = self.leaving.iter_mut().map(|leaving| &mut leaving.worker);
        asked.chain(leaving).chain(self.spares.workers()).for_each(Worker::kill);
    }
}
