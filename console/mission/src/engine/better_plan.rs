//! Better plans. After a repair, a second worker of the same planner makes a plan for the rest of the task while the
//! robot continues.
//!
//! The second worker receives no plan to keep to. Its plan begins at a place ahead on the current plan: floor on the
//! way there counts as scanned, and the cable counts as laid up to there. If the new plan saves enough time to justify
//! a change, it is offered, or taken when the robot reaches that place. If the current plan changes before then, the
//! new plan is dropped.

mod worth;

use super::{
    Mission,
    driving::{Driving, Prepare},
    requests::AskedPlan,
    role::{Better, Offer, Preparing, Role},
    worker::Worker,
};
use crate::{
    ask::{AskId, Said},
    config::BetterPlan,
    event::{Effort, EventKind, OfferEnd, OfferStage, PlanDropped, PlanMade, PlanTaken},
    task::rest_of,
};
use geometry::PathFollower;
use planner_api::{Plan, Reason};
use world::Point;

/// Time between finding an obstacle and searching for a better plan, seconds: obstacles are often found in groups, and
/// their outlines are corrected while the robot passes.
const SETTLE_S: f64 = 20.0;
/// Distance along the path within which the robot counts as having reached the start of the better plan, metres.
const AT_JOINT_M: f64 = 0.05;

impl Mission {
    /// Schedules the search for a better plan after a repaired plan has been taken, if the mission wants better plans.
    pub(super) fn want_better_plan(&mut self) {
        let wanted = self.known.config.wants_better_plans() && self.known.is_coverage();
        self.better_plan_due_s = wanted.then(|| self.known.now_s() + SETTLE_S);
    }

    /// Handles a change to the map: a better plan that is being made is out of date, and a scheduled search waits until
    /// the map has settled.
    pub(super) fn postpone_better_plan(&mut self) {
        let is_under_way = self.better().is_some();
        self.drop_better_plan(OfferEnd::MapChanged);
        if is_under_way || self.better_plan_due_s.is_some() {
            self.want_better_plan();
        }
    }

    fn better(&self) -> Option<&Better> {
        match &self.preparing {
            Some(Preparing { role: Role::Better(better), .. }) => Some(better),
            _ => None,
        }
    }

    /// The stage of the offer of a better plan; `None` if no plan is offered or accepted.
    pub(super) fn offer_stage(&self) -> Option<OfferStage> {
        self.better()?.stage(self.known.config.better_plan)
    }

    /// Orders the better plan to be taken at the place where it begins.
    pub(super) fn order_better_plan(&mut self) {
        if let Some(Preparing { role: Role::Better(Better::Offered(offer)), .. }) = &mut self.preparing {
            offer.is_ordered = true;
        }
    }

    /// Abandons a better plan that is being made or offered, if there is one.
    pub(super) fn drop_better_plan(&mut self, reason: OfferEnd) {
        let dropped = self.preparing.take_if(|preparing| matches!(preparing.role, Role::Better(_)));
        if let Some(Preparing { worker, role: Role::Better(better) }) = dropped {
            self.close_better_plan(worker, &better, reason);
        }
    }

    pub(super) fn close_better_plan(&mut self, mut worker: Worker, better: &Better, reason: OfferEnd) {
        self.workers.close(worker.leave());
        let (planner, why) = (worker.choice.id, reason.to_string());
        let stage = better.stage(self.known.config.better_plan);
        self.happened.push(EventKind::BetterPlanDropped(PlanDropped {
            planner,
            why,
            stage,
            reason: Some(reason),
        }));
    }

    /// Starts the search for a better plan if one is due. When the robot reaches the place where an offered plan begins,
    /// takes or drops that plan.
    pub(super) fn lead_better_plan(&mut self) {
        if self.is_better_plan_due() {
            self.better_plan_due_s = None;
            if self.known.joint().is_some() {
                let worker = self.driving.worker.successor(self.driving.worker.choice.clone());
                self.preparing = Some(Preparing { worker, role: Role::Better(Better::Opening) });
            }
        }
        let Some(better) = self.better() else { return };
        if !self.driving.is_flying() {
            return self.drop_better_plan(OfferEnd::OtherPlan);
        }
        let along_m = self.known.task.lanes().map_or(0.0, PathFollower::along_m);
        let is_there = better.joint().is_some_and(|joint| along_m >= joint.station_m - AT_JOINT_M);
        if !self.known.follows_planner() || !is_there {
            return;
        }
        let takes_any = self.known.config.better_plan == BetterPlan::Take;
        match better {
            Better::Offered(offer) if offer.is_ordered || takes_any => self.take_better_plan(),
            Better::Offered(_) => self.drop_better_plan(OfferEnd::Passed),
            _ => self.drop_better_plan(OfferEnd::TooLate),
        }
    }

    fn is_better_plan_due(&self) -> bool {
        let is_due = self.better_plan_due_s.is_some_and(|due_s| due_s <= self.known.now_s());
        let is_steady = self.driving.is_flying() && self.driving.newest_change().is_none();
        is_due && is_steady && self.preparing.is_none() && self.known.follows_planner()
    }

    /// Judges a plan for the rest of the task; returns the planner if its plan is offered.
    pub(super) fn better_plan_arrived(
        &mut self,
        mut worker: Worker,
        better: &Better,
        ask: AskId,
        plan: Plan,
    ) -> Option<Preparing> {
        let (cover, joint) = (self.known.task.cover()?, better.joint()?);
        let way = cover.way_to(&joint);
        let rest = cover.path_from(&joint);
        // The turn at the point where the two plans join counts, too.
        let before = &way[way.len().saturating_sub(2)..way.len().saturating_sub(1)];
        let effort = |path: &[Point]| Effort::of(&[before, path].concat(), &self.known.config.limits);
        let (flown, better) = (effort(&rest), effort(&plan.path));
        let (scans, objection) = self.known.judge_better(&way, &rest, (flown, better), &plan);
        self.happened.push(EventKind::BetterPlanned(PlanMade {
            ask,
            planner: worker.id().to_owned(),
            path: plan.path.clone(),
            complete: plan.complete,
            legs: plan.legs.clone(),
            cuts: plan.cuts.clone(),
            flown,
            better,
            scans,
            objection: objection.clone(),
        }));
        if objection.is_some() {
            self.workers.close(worker.leave());
            return None;
        }
        let offer = Offer { joint, plan, flown, better, is_ordered: false };
        Some(Preparing { worker, role: Role::Better(Better::Offered(Box::new(offer))) })
    }

    /// Switches to the better plan; the robot is at the place where it begins.
    fn take_better_plan(&mut self) {
        let Some(Preparing { worker, role: Role::Better(Better::Offered(offer)) }) = self.preparing.take()
        else {
            return;
        };
        let Offer { flown, better, .. } = *offer;
        let (here, planner) = (self.known.position(), worker.id().to_owned());
        let asked = AskedPlan::from_here(Reason::MapChanged, here);
        let mut evaluated = self.known.evaluate(None, &planner, &asked, rest_of(&offer.plan, 0.0, &[here]));
        if let Some(objection) = evaluated.objection.take() {
            let reason = OfferEnd::Unsafe { message: objection.message };
            return self.close_better_plan(worker, &Better::Offered(offer), reason);
        }
        self.happened.push(EventKind::BetterPlanTaken(PlanTaken { planner, flown, better }));
        self.take_over(Driving::with_plan(worker, Vec::new(), Prepare::No), Said::default(), evaluated);
        self.left = None;
    }
}
