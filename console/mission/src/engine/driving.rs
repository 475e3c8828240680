//! The planner that drives.

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

/// The planner that drives, or that will drive first.
#[derive(Clone, Default)]
pub(super) struct Driving {
    pub worker: Worker,
    pub course: Course,
    /// A plan of its own that it is to keep to, other than the one that is flown.
    pub keep: Option<Plan>,
    /// How far it is to be prepared while the robot stands.
    pub prepare: Prepare,
    /// The plan that it made before the start, or why that may not be run; `None` where nobody looks at it.
    pub first_plan: Option<Result<PlanId, String>>,
    /// What its live parameters are to become.
    pub reconfigure: Option<PlannerChoice>,
    /// Whether its state is wanted for the instance that replaces it.
    pub snapshot_due: bool,
    /// Mission time of the last snapshot, or of the first command, seconds.
    saved_at_s: Option<f64>,
    /// Its command for this tick.
    command: Option<Arrived>,
    /// The tick for which it was asked last to command.
    stepped_at: Option<u64>,
    /// Whether it answers late.
    late: LatePlannerRule,
    /// Whether it says that it cannot go on.
    blocked: BlockedRule,
}

/// How far a planner is to be prepared while the robot stands.
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

/// A plan that was being flown when another planner took over.
#[derive(Clone)]
pub(super) struct LeftPlan {
    choice: PlannerChoice,
    /// What was left of it.
    plan: Plan,
    /// Where the robot was.
    at: Point,
}

impl LeftPlan {
    /// The plan, for the planner that flew it with the same values, if the robot is still within `near_m` of where it was left:
    /// whoever is called back goes on with it.
    pub(super) fn to_go_on_with(&self, choice: &PlannerChoice, here: Point, near_m: f64) -> Option<Plan> {
        (self.choice == *choice && (self.at - here).norm() < near_m).then(|| self.plan.clone())
    }
}

impl Driving {
    /// A planner that drives as soon as it has a plan, why it is asked for one, and how far it is prepared before.
    pub(super) fn new(worker: Worker, reason: Reason, prepare: Prepare) -> Self {
        Self { worker, course: Course::new(reason), prepare, ..Self::default() }
    }

    /// A planner that has planned already; what was found since may stand in the way.
    pub(super) fn with_plan(worker: Worker, found_since: Vec<Shape>, prepare: Prepare) -> Self {
        let course = Course { found_since, ..Course::default() };
        Self { worker, course, prepare, ..Self::default() }
    }

    /// The planner's id.
    pub(super) fn id(&self) -> &str {
        self.worker.id()
    }

    /// Whether it is there and flies a plan.
    pub(super) fn is_flying(&self) -> bool {
        self.worker.is_ready() && self.course.has_plan()
    }

    /// What rules see of it.
    pub(super) fn seen(&self, known: &Known, is_waited_for: bool) -> PlannerSeen<'_> {
        let pending = self.worker.pending.as_ref();
        let owed =
            pending.filter(|_| !self.worker.is_being_prepared()).map(|pending| known.tick - pending.tick);
        PlannerSeen {
            id: self.id(),
            is_waited_for,
            owes: pending.is_some(),
            owed_s: owed.map(|ticks| ticks as f64 * known.config.tick_s),
        }
    }

    /// Whether its state is asked for, or is about to be.
    pub(super) fn is_saving(&self) -> bool {
        let is_snapshot = self.worker.pending.as_ref().is_some_and(|p| p.kind == PendingKind::Snapshot);
        self.snapshot_due || is_snapshot
    }

    /// Flies a plan from now on.
    pub(super) fn take_plan(&mut self, plan: &Plan, known: &Known) {
        self.keep = None;
        self.course.keep_to_cuts(plan, known);
        self.course.take(plan);
        self.outdate_step();
        self.course.doubt_fresh_plan(&known.task, known.config.room_m());
    }

    /// What is left of the plan that it flies, for the case that it is called back.
    pub(super) fn left_plan(&self, known: &Known) -> Option<LeftPlan> {
        let plan = self.course.has_plan().then(|| known.task.under_way()).flatten()?;
        Some(LeftPlan { choice: self.worker.choice.clone(), plan, at: known.position() })
    }

    /// Has its worker closed.
    pub(super) fn close(&mut self, workers: &mut Workers, happened: &mut Happened) {
        self.drop_command(happened);
        workers.close(self.leave_worker());
    }

    /// Forgets the instance, which the host closes, and its open requests.
    pub(super) fn leave_worker(&mut self) -> Option<WorkerId> {
        (self.snapshot_due, self.command, self.reconfigure) = (false, None, None);
        self.worker.leave()
    }
}
