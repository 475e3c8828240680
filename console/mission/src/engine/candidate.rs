//! A planner that is being prepared to take over.

use super::{
    Mission,
    course::Due,
    driving::{Driving, Prepare},
    planning::planned,
    requests::AskedPlan,
    role::{Candidate, Preparing, Role},
    worker::Worker,
};
use crate::{
    ask::{AskId, Said},
    event::{EventKind, OfferEnd},
    standing::NEAR_PLAN_M,
};
use planner_api::Plan;

/// A candidate that plans again keeps to its first plan if the robot has moved at most this far, metres. If the robot
/// has moved farther, too much floor would be scanned twice.
const MOST_GONE_M: f64 = 3.0;

impl Mission {
    /// Processes the plan of a candidate; returns the candidate unless it has taken over or has been closed.
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
            // The robot has moved on in the meantime. The candidate plans again from here, and this time the robot waits.
            self.happened.pass_on(said, worker.id());
            let is_kept = gone_m <= MOST_GONE_M && self.known.is_coverage();
            // Recorded because the next ask to the planner includes it.
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

    /// Rejects the planner that is being prepared, because a different one takes over.
    pub(super) fn reject_preparing(&mut self, why: &str) {
        self.drop_better_plan(OfferEnd::OtherPlannerActive);
        if let Some(Preparing { worker, .. }) = self.preparing.take() {
            self.reject(worker, why.to_owned());
        }
    }
}
