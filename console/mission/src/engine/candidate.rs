//! A planner that is being prepared to take over.

use super::{
    Mission,
    course::Due,
    driving::{Driving, Prepare},
    known::Known,
    planning::planned,
    preparing::{Preparing, Role},
    requests::AskedPlan,
    worker::Worker,
};
use crate::{
    ask::{AskId, PlanAsk, Said},
    event::EventKind,
};
use planner_api::{Plan, Reason};
use world::Shape;

/// A candidate whose plan begins further from the robot than this plans again, metres.
pub(super) const NEAR_PLAN_M: f64 = 0.5;
/// It keeps to that plan if the robot has gone no further, metres: more floor would be scanned twice.
const MOST_GONE_M: f64 = 3.0;

/// A planner that takes over as soon as it has a plan that flies.
#[derive(Clone)]
pub(super) struct Candidate {
    /// The plan that it is to make.
    due: Due,
    /// A plan of its own that it is to keep to, other than the one that is flown.
    keep: Option<Plan>,
    /// What was found since the plan was asked for that is being made.
    pub found_since: Vec<Shape>,
    /// Whether the robot stands until it has planned: by the time that it had, the robot had gone on.
    pub robot_waits: bool,
}

impl Candidate {
    /// A planner that is still to be opened, why it is to take over, and a plan that it is to keep to.
    pub(super) fn prepare(worker: Worker, reason: Reason, keep: Option<Plan>) -> Preparing {
        let due = Due::from_here(reason);
        let candidate = Self { due, keep, found_since: Vec::new(), robot_waits: false };
        Preparing { worker, role: Role::Candidate(candidate) }
    }

    pub(super) fn plan_ask(&mut self, known: &Known) -> (AskedPlan, PlanAsk) {
        self.found_since.clear();
        known.plan_ask(&self.due, known.trail.len(), self.keep.clone())
    }
}

impl Mission {
    /// Takes the plan of a candidate; gives it back unless it has taken over or is closed.
    pub(super) fn candidate_planned(
        &mut self,
        worker: Worker,
        mut candidate: Candidate,
        (ask, asked): (AskId, AskedPlan),
        plan: Plan,
        said: Said,
    ) -> Option<Preparing> {
        let gone_m = (self.known.position() - asked.here).norm();
        if gone_m > NEAR_PLAN_M {
            // The robot went on meanwhile. It plans again from here, and this time the robot waits for it.
            self.happened.pass_on(said, worker.id());
            let is_kept = gone_m <= MOST_GONE_M && self.known.is_coverage();
            // The journal repeats what the planner is asked next.
            let from_here = AskedPlan::from_here(asked.reason, asked.here);
            let planned = is_kept.then(|| Box::new(planned(Some(ask), worker.id(), &from_here, &plan)));
            self.happened.push(EventKind::Discarded { ask, plan: planned });
            (candidate.robot_waits, candidate.keep) = (true, is_kept.then_some(Plan { cost: 0.0, ..plan }));
            return Some(Preparing { worker, role: Role::Candidate(candidate) });
        }
        let mut evaluated = self.known.evaluate(Some(ask), worker.id(), &asked, plan);
        let Some(objection) = evaluated.objection.take() else {
            self.take_over(Driving::with_plan(worker, candidate.found_since, Prepare::Plan), said, evaluated);
            return None;
        };
        self.happened.pass_on(said, worker.id());
        self.happened.extend(evaluated.events);
        if objection.by_tether && self.known.may_try_from_anchor(&asked) {
            candidate.due = Due::from_anchor(asked.reason);
            return Some(Preparing { worker, role: Role::Candidate(candidate) });
        }
        self.reject(worker, objection.message);
        None
    }

    pub(super) fn reject(&mut self, mut worker: Worker, why: String) {
        self.workers.close(worker.leave());
        self.happened.push(EventKind::PlannerRejected { planner: worker.choice.id, why });
    }

    /// Another planner takes over than the one that is being prepared.
    pub(super) fn reject_preparing(&mut self, why: &str) {
        self.drop_better_plan("another planner drives");
        if let Some(Preparing { worker, .. }) = self.preparing.take() {
            self.reject(worker, why.to_owned());
        }
    }
}
