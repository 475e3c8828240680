//! The active planner.

mod asks;
mod commands;
mod orders;

use super::{
    course::Course,
    happened::Happened,
    known::Known,
    rules::{BlockedRule, LatePlannerRule, PlannerSeen},
    worker::{PendingKind, Worker},
    workers::Workers,
};
use crate::{ask::WorkerId, plan_id::PlanId, planner::PlannerChoice};
use commands::Arrived;
pub use commands::Sending;
use planner_api::{Plan, Reason};
use world::{Point, Shape};

/// The active planner or, before there is one, the planner that will be active first.
#[derive(Clone, Default)]
pub(super) struct Driving {
    pub worker: Worker,
    pub course: Course,
    /// The plan that the planner is asked to keep to. This is the planner's own plan, not the plan in use.
    pub keep: Option<Plan>,
    /// How far to prepare the planner while the robot stands still.
    pub prepare: Prepare,
    /// The plan made before the start, or why it cannot be run; `None` if no plan is shown to anyone.
    pub first_plan: Option<Result<PlanId, String>>,
    /// New values for the planner's live parameters, not sent yet.
    pub reconfigure: Option<PlannerChoice>,
    /// Whether a snapshot of the planner's state is due, for the instance that will replace it.
    pub snapshot_due: bool,
    /// Mission time of the last snapshot or, until there is one, of the first command, seconds.
    saved_at_s: Option<f64>,
    /// Command from the planner for this tick.
    command: Option<Arrived>,
    /// The last tick for which a command was requested.
    stepped_at: Option<u64>,
    /// Tracks late answers.
    late: LatePlannerRule,
    /// Tracks commands that report that the planner cannot continue.
    blocked: BlockedRule,
}

/// How far a planner is prepared while the robot stands still.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) enum Prepare {
    /// Do not prepare the planner.
    #[default]
    No,
    /// Open the planner.
    Open,
    /// Make a plan.
    Plan,
}

/// The plan that was in use when another planner took over.
#[derive(Clone)]
pub(super) struct LeftPlan {
    choice: PlannerChoice,
    /// The rest of the plan.
    plan: Plan,
    /// The position of the robot when the other planner took over.
    at: Point,
}

impl LeftPlan {
    /// The plan, provided that `choice` names the planner that made it, with the same parameter values, and that the
    /// robot is still within `near_m` of the point where it left the plan. If the mission switches back to a planner,
    /// the planner continues its old plan.
    pub(super) fn to_go_on_with(&self, choice: &PlannerChoice, here: Point, near_m: f64) -> Option<Plan> {
        (self.choice == *choice && (self.at - here).norm() < near_m).then(|| self.plan.clone())
    }
}

impl Driving {
    /// Creates the state of a planner that becomes active as soon as it has a plan, given the reason for the plan and
    /// how far to prepare the planner.
    pub(super) fn new(worker: Worker, reason: Reason, prepare: Prepare) -> Self {
        Self { worker, course: Course::new(reason), prepare, ..Self::default() }
    }

    /// A planner that already has a plan; obstacles found since the plan was requested may block it.
    pub(super) fn with_plan(worker: Worker, found_since: Vec<Shape>, prepare: Prepare) -> Self {
        let course = Course { found_since, ..Course::default() };
        Self { worker, course, prepare, ..Self::default() }
    }

    /// The planner's id.
    pub(super) fn id(&self) -> &str {
        self.worker.id()
    }

    /// Whether the planner is open and has a plan in use.
    pub(super) fn is_flying(&self) -> bool {
        self.worker.is_ready() && self.course.has_plan()
    }

    /// The planner as the rules see it.
    pub(super) fn seen(&self, known: &Known, is_waited_for: bool) -> PlannerSeen<'_> {
        let pending = self.worker.pending.as_ref();
        let owed =
            pending.filter(|_| !self.worker.is_being_prepared()).map(|pending| known.tick - pending.tick);
        PlannerSeen {
            id: self.id(),
            is_waited_for,
            owes: pending.is_some(),
            owed_s: owed.map(|ticks| ticks as f64 * known.config.tick_s),
            is_shut_in: self.blocked.is_shut_in(),
        }
    }

    /// Whether a snapshot has been requested or is due.
    pub(super) fn is_saving(&self) -> bool {
        let is_snapshot = self.worker.pending.as_ref().is_some_and(|p| p.kind == PendingKind::Snapshot);
        self.snapshot_due || is_snapshot
    }

    /// Switches to a plan.
    pub(super) fn take_plan(&mut self, plan: &Plan, known: &Known) {
        self.keep = None;
        self.course.keep_to_cuts(plan, known);
        self.course.take(plan);
        self.outdate_step();
        self.course.doubt_fresh_plan(&known.task, known.config.room_m());
    }

    /// The rest of the current plan, in case the planner becomes active again.
    pub(super) fn left_plan(&self, known: &Known) -> Option<LeftPlan> {
        let plan = self.course.has_plan().then(|| known.task.under_way()).flatten()?;
        Some(LeftPlan { choice: self.worker.choice.clone(), plan, at: known.position() })
    }

    /// Closes its worker.
    pub(super) fn close(&mut self, workers: &mut Workers, happened: &mut Happened) {
        self.drop_command(happened);
        workers.close(self.leave_worker());
    }

    /// Forgets the instance, which the host closes, and the open asks of that instance.
    pub(super) fn leave_worker(&mut self) -> Option<WorkerId> {
        (self.snapshot_due, self.command, self.reconfigure) = (false, None, None);
        self.worker.leave()
    }
}
