//! A planner of the mission: how far it is prepared, its plan, and what is asked of it.

use super::{
    better_plan::Better,
    requests::AskedPlan,
    rules::{BlockedRule, CutsRule, LatePlannerRule},
};
use crate::{
    ask::{Ask, AskId, Said, Site, What, WorkerId},
    plan_id::PlanId,
    planner::{PlannerChoice, PlannerInfo},
};
use geometry::PathFollower;
use planner_api::{Command, Plan, Reason};
use std::sync::Arc;
use world::{Point, Shape};

/// A planner with its worker, its plan and its open ask.
///
/// The mission has an active one, which drives, and at most one candidate, which is prepared to take over.
#[derive(Clone, Default)]
pub(super) struct PlannerSlot {
    pub choice: PlannerChoice,
    /// Who it is, from the first time that it was opened.
    pub info: Option<PlannerInfo>,
    /// Whether it is loaded, configured and has not failed since.
    pub is_ready: bool,
    pub plan: PlanState,
    /// The plan that it made before the start, or why that may not be run; `None` where nobody looks at it.
    pub first_plan: Option<Result<PlanId, String>>,
    /// A plan of its own that it is to keep to, other than the one that is flown.
    pub keep: Option<Plan>,
    /// How far it is to be prepared while it does not drive.
    pub prepare: Prepare,
    /// The instance that runs; `None` before the first, and after a fault.
    pub worker: Option<WorkerId>,
    n_asks: u32,
    /// The ask that has not been answered yet.
    pub pending: Option<Pending>,
    /// The newest state that it saved.
    pub saved: Option<AskId>,
    /// Mission time of the last snapshot, or of the first command, seconds.
    pub saved_at_s: Option<f64>,
    /// Whether its state is wanted for the instance that replaces it.
    pub snapshot_due: bool,
    /// What its live parameters are to become.
    pub reconfigure: Option<PlannerChoice>,
    /// Which planner drove before it.
    pub before: Option<PlannerInfo>,
    /// Its plan, for tasks that do not follow it by themselves.
    pub follower: Option<PathFollower>,
    /// What was found since the plan was asked for that is being made.
    pub found_since: Vec<Shape>,
    /// From where on what it plans is to take the place of the plan that is flown; `None` for one that takes over as soon as it
    /// has a plan.
    pub better: Option<Box<Better>>,
    /// Whether the robot stands until it has planned: by the time that it had, the robot had gone on.
    pub robot_waits: bool,
    /// Its command for this tick.
    pub command: Option<Arrived>,
    /// The tick for which it was asked last to command.
    pub stepped_at: Option<u64>,
    /// Whether it answers late.
    pub late: LatePlannerRule,
    /// The lines that its plan never crosses.
    pub cuts: CutsRule,
    /// Whether it says that it cannot go on.
    pub blocked: BlockedRule,
}

/// A plan that was being flown when another planner took over.
#[derive(Clone)]
pub(super) struct LeftPlan {
    /// Who flew it, with which values.
    pub choice: PlannerChoice,
    /// What was left of it.
    pub plan: Plan,
    /// Where the robot was.
    pub at: Point,
}

/// How far a planner is to be prepared without driving.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) enum Prepare {
    /// Not at all.
    #[default]
    No,
    /// It shall be opened.
    Open,
    /// It shall have a plan.
    Plan,
}

/// The plan of a planner.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum PlanState {
    /// It is still to be made, or is being made.
    Due {
        /// Why.
        reason: Reason,
        /// Whether it is to begin at the anchor, after a return path: from here it was refused for the tether.
        from_anchor: bool,
    },
    /// It is being flown.
    Flying {
        /// Whether it is for all that was left of the task.
        is_whole: bool,
    },
}

impl Default for PlanState {
    fn default() -> Self {
        Self::due(Reason::Start)
    }
}

impl PlanState {
    /// A plan that is wanted from where the robot stands.
    pub(super) fn due(reason: Reason) -> Self {
        Self::Due { reason, from_anchor: false }
    }
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

/// A command that has arrived.
#[derive(Clone)]
pub(super) struct Arrived {
    pub ask: AskId,
    pub command: Command,
    pub said: Said,
    /// For how many ticks the robot stood still for it, if a row of late ones begins with it.
    pub late_ticks: Option<u64>,
}

impl PlannerSlot {
    /// A planner that has not been opened, and why it will be asked for a plan.
    pub(super) fn new(choice: PlannerChoice, reason: Reason) -> Self {
        Self { choice, plan: PlanState::due(reason), ..Self::default() }
    }

    /// The same planner with other parameters, or another one, to take this one's place.
    pub(super) fn successor(&self, choice: PlannerChoice, reason: Reason) -> Self {
        let same = choice.id == self.choice.id;
        Self {
            saved: self.saved.filter(|_| same),
            before: self.known().cloned(),
            ..Self::new(choice, reason)
        }
    }

    /// Who it is, or, until it is opened, who drove before it.
    pub(super) fn known(&self) -> Option<&PlannerInfo> {
        self.info.as_ref().or(self.before.as_ref())
    }

    /// Whether it has a plan and no other is due.
    pub(super) fn has_plan(&self) -> bool {
        matches!(self.plan, PlanState::Flying { .. })
    }

    /// Whether its last plan was for all that was left of the task.
    pub(super) fn is_plan_whole(&self) -> bool {
        !matches!(self.plan, PlanState::Flying { is_whole: false })
    }

    /// Wants another plan, unless one is wanted already.
    pub(super) fn want_plan(&mut self, reason: Reason) {
        if self.has_plan() {
            self.plan = PlanState::due(reason);
        }
    }

    /// Has a new worker open this planner.
    pub(super) fn open(&mut self, worker: WorkerId, tick: u64, site: Site) -> Ask {
        (self.worker, self.n_asks, self.saved_at_s) = (Some(worker), 0, None);
        let (choice, site, restore) = (self.choice.clone(), Arc::new(site), self.saved);
        self.number(worker, tick, PendingKind::Open, What::Open { choice, site, restore })
    }

    /// Asks something of the worker; `None` without one.
    pub(super) fn ask(&mut self, tick: u64, kind: PendingKind, what: What) -> Option<Ask> {
        Some(self.number(self.worker?, tick, kind, what))
    }

    /// Numbers the next ask and remembers it until the answer.
    fn number(&mut self, worker: WorkerId, tick: u64, kind: PendingKind, what: What) -> Ask {
        self.n_asks += 1;
        let id = AskId { worker, n: self.n_asks };
        self.pending = Some(Pending { id, tick, kind });
        Ask { id, what }
    }

    /// Forgets the worker, which is to be closed.
    pub(super) fn leave_worker(&mut self) -> Option<WorkerId> {
        (self.is_ready, self.snapshot_due) = (false, false);
        (self.pending, self.command, self.reconfigure) = (None, None, None);
        self.worker.take()
    }

    /// Whether it is being opened or is making a plan.
    pub(super) fn is_being_prepared(&self) -> bool {
        matches!(&self.pending, Some(Pending { kind: PendingKind::Open | PendingKind::Plan(_), .. }))
    }

    /// The newest change of live parameters that it has not answered yet.
    pub(super) fn newest_change(&self) -> Option<&PlannerChoice> {
        let asked = self.pending.as_ref().and_then(|pending| match &pending.kind {
            PendingKind::Reconfigure(choice) => Some(choice),
            _ => None,
        });
        self.reconfigure.as_ref().or(asked)
    }

    /// For how many ticks it has owed an answer that a moving robot needs.
    pub(super) fn owed_ticks(&self, tick: u64) -> Option<u64> {
        let pending = self.pending.as_ref()?;
        (!self.is_being_prepared()).then(|| tick - pending.tick)
    }

    /// No answer to a step that was asked before is of use any more.
    pub(super) fn outdate_step(&mut self) {
        if let Some(Pending { kind: PendingKind::Step { usable }, .. }) = &mut self.pending {
            *usable = false;
        }
    }
}
