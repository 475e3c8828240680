//! A planner in a worker process: its identity and its open requests.

use super::{known::Known, requests::AskedPlan, workers::Workers};
use crate::{
    ask::{Ask, AskId, PlanAsk, What, WorkerId},
    planner::{PlannerChoice, PlannerInfo},
};
use std::sync::Arc;

/// A planner with its worker process and its open ask, whatever it is there for.
#[derive(Clone, Default)]
pub(super) struct Worker {
    pub choice: PlannerChoice,
    /// Who it is, from the first time that it was opened.
    pub info: Option<PlannerInfo>,
    /// Which planner drove before it.
    pub before: Option<PlannerInfo>,
    /// The newest state that it saved.
    pub saved: Option<AskId>,
    /// The ask that has not been answered yet.
    pub pending: Option<Pending>,
    /// The instance that runs; `None` before the first, and after a fault.
    instance: Option<WorkerId>,
    n_asks: u32,
}

/// An ask without an answer.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pending {
    pub id: AskId,
    /// When it was asked.
    pub tick: u64,
    pub kind: PendingKind,
}

/// What was asked, with what has to be remembered until the answer.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum PendingKind {
    Open,
    Reconfigure(PlannerChoice),
    Plan(AskedPlan),
    Step {
        /// Whether the robot has not been held and no other plan has been taken since.
        usable: bool,
    },
    Snapshot,
    /// A step that was asked of it in shadow, before it took over: the answer is of no use, and not late.
    StepInShadow,
}

impl Worker {
    /// A planner that has not been opened.
    pub(super) fn new(choice: PlannerChoice) -> Self {
        Self { choice, ..Self::default() }
    }

    /// The same planner with other parameters, or another one, to take this one's place.
    pub(super) fn successor(&self, choice: PlannerChoice) -> Self {
        let saved = self.saved.filter(|_| choice.id == self.choice.id);
        Self { saved, before: self.seen().cloned(), ..Self::new(choice) }
    }

    /// The planner's id.
    pub(super) fn id(&self) -> &str {
        &self.choice.id
    }

    /// Who it is, or, until it is opened, who drove before it.
    pub(super) fn seen(&self) -> Option<&PlannerInfo> {
        self.info.as_ref().or(self.before.as_ref())
    }

    /// Whether it is loaded and configured, and has not failed since.
    pub(super) fn is_ready(&self) -> bool {
        self.instance.is_some()
            && !matches!(&self.pending, Some(pending) if pending.kind == PendingKind::Open)
    }

    /// Whether it is being opened or is making a plan.
    pub(super) fn is_being_prepared(&self) -> bool {
        matches!(&self.pending, Some(Pending { kind: PendingKind::Open | PendingKind::Plan(_), .. }))
    }

    /// Has a new instance open this planner.
    pub(super) fn open(&mut self, known: &Known, workers: &mut Workers) -> Ask {
        let instance = workers.next();
        (self.instance, self.n_asks) = (Some(instance), 0);
        let (choice, site, restore) = (self.choice.clone(), Arc::new(known.chart.site()), self.saved);
        self.number(instance, known.tick, PendingKind::Open, What::Open { choice, site, restore })
    }

    /// Asks something of the instance that runs; `None` without one.
    pub(super) fn ask(&mut self, tick: u64, kind: PendingKind, what: What) -> Option<Ask> {
        Some(self.number(self.instance?, tick, kind, what))
    }

    /// Asks for a plan.
    pub(super) fn ask_for_plan(&mut self, tick: u64, (asked, ask): (AskedPlan, PlanAsk)) -> Option<Ask> {
        self.ask(tick, PendingKind::Plan(asked), What::Plan(Box::new(ask)))
    }

    /// Numbers the next ask and remembers it until the answer.
    fn number(&mut self, worker: WorkerId, tick: u64, kind: PendingKind, what: What) -> Ask {
        self.n_asks += 1;
        let id = AskId { worker, n: self.n_asks };
        self.pending = Some(Pending { id, tick, kind });
        Ask { id, what }
    }

    /// What was asked, if this is the ask without an answer, which it has got now.
    pub(super) fn answered(&mut self, ask: AskId) -> Option<Pending> {
        self.pending.take_if(|pending| pending.id == ask)
    }

    /// Forgets the instance, which is to be closed.
    pub(super) fn leave(&mut self) -> Option<WorkerId> {
        self.pending = None;
        self.instance.take()
    }
}
