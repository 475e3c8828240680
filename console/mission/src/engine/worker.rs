//! A planner in a worker process, with its identity and its open asks.

use super::{known::Known, requests::AskedPlan, workers::Workers};
use crate::{
    ask::{Ask, AskId, PlanAsk, What, WorkerId},
    planner::{PlannerChoice, PlannerInfo},
};
use std::sync::Arc;

/// A planner with its worker process and its open ask, whatever its role in the mission.
#[derive(Clone, Default)]
pub(super) struct Worker {
    pub choice: PlannerChoice,
    /// Description of the planner, known once the planner has been opened for the first time.
    pub info: Option<PlannerInfo>,
    /// Description of the planner that was active before this one.
    pub before: Option<PlannerInfo>,
    /// The last state that the planner saved.
    pub saved: Option<AskId>,
    /// The open ask.
    pub pending: Option<Pending>,
    /// The running instance; `None` until the first one is started, and after a fault.
    instance: Option<WorkerId>,
    n_asks: u32,
}

/// An open ask.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pending {
    pub id: AskId,
    /// The tick in which the ask was issued.
    pub tick: u64,
    pub kind: PendingKind,
}

/// The kind of ask, with the data that the mission must keep until the answer arrives.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum PendingKind {
    Open,
    Reconfigure(PlannerChoice),
    Plan(AskedPlan),
    Step {
        /// Whether the answer can still be used: the robot has not been held, and no new plan has been taken, since the
        /// ask.
        usable: bool,
    },
    Snapshot,
    /// A step requested in shadow, before the planner took over: its answer is not used and does not count as late.
    StepInShadow,
}

impl Worker {
    /// Creates a planner that has not been opened.
    pub(super) fn new(choice: PlannerChoice) -> Self {
        Self { choice, ..Self::default() }
    }

    /// Creates a worker that will replace this one: for the same planner with other parameters, or for a different
    /// planner.
    pub(super) fn successor(&self, choice: PlannerChoice) -> Self {
        let saved = self.saved.filter(|_| choice.id == self.choice.id);
        Self { saved, before: self.seen().cloned(), ..Self::new(choice) }
    }

    /// The planner's id.
    pub(super) fn id(&self) -> &str {
        &self.choice.id
    }

    /// Description of the planner or, until the planner is opened, of the planner before it.
    pub(super) fn seen(&self) -> Option<&PlannerInfo> {
        self.info.as_ref().or(self.before.as_ref())
    }

    /// Whether the planner is open and configured, and has not failed since.
    pub(super) fn is_ready(&self) -> bool {
        self.instance.is_some()
            && !matches!(&self.pending, Some(pending) if pending.kind == PendingKind::Open)
    }

    /// The running instance, if it owes no answer.
    pub(super) fn idle(&self) -> Option<WorkerId> {
        self.instance.filter(|_| self.pending.is_none())
    }

    /// Whether the planner is being opened or is making a plan.
    pub(super) fn is_being_prepared(&self) -> bool {
        matches!(&self.pending, Some(Pending { kind: PendingKind::Open | PendingKind::Plan(_), .. }))
    }

    /// Starts a new instance of the planner.
    pub(super) fn open(&mut self, known: &Known, workers: &mut Workers) -> Ask {
        let instance = workers.next();
        (self.instance, self.n_asks) = (Some(instance), 0);
        let (choice, site, restore) = (self.choice.clone(), Arc::new(known.chart.site()), self.saved);
        self.number(instance, known.tick, PendingKind::Open, What::Open { choice, site, restore })
    }

    /// Sends an ask to the running instance; `None` without one.
    pub(super) fn ask(&mut self, tick: u64, kind: PendingKind, what: What) -> Option<Ask> {
        Some(self.number(self.instance?, tick, kind, what))
    }

    /// Requests a plan.
    pub(super) fn ask_for_plan(&mut self, tick: u64, (asked, ask): (AskedPlan, PlanAsk)) -> Option<Ask> {
        self.ask(tick, PendingKind::Plan(asked), What::Plan(Box::new(ask)))
    }

    /// Numbers the next ask, and remembers it until its answer arrives.
    fn number(&mut self, worker: WorkerId, tick: u64, kind: PendingKind, what: What) -> Ask {
        self.n_asks += 1;
        let id = AskId { worker, n: self.n_asks };
        self.pending = Some(Pending { id, tick, kind });
        Ask { id, what }
    }

    /// Takes the open ask if it has this id.
    pub(super) fn answered(&mut self, ask: AskId) -> Option<Pending> {
        self.pending.take_if(|pending| pending.id == ask)
    }

    /// Forgets the instance; the caller must close it.
    pub(super) fn leave(&mut self) -> Option<WorkerId> {
        self.pending = None;
        self.instance.take()
    }
}
