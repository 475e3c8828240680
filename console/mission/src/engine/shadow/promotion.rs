//! Promotes the planner in shadow: it takes over within one tick, with its plan from the robot's current position, and
//! without a hold.

use super::{
    super::{
        Mission,
        course::Due,
        driving::{Driving, Prepare},
        planning::Evaluated,
        requests::AskedPlan,
        worker::PendingKind,
    },
    Shadow,
};
use crate::{
    ask::Said,
    event::EventKind,
    order::Order,
    phase::Phase,
    task::{Task, rest_of},
};
use planner_api::{Plan, Reason};
use world::{Point, polyline};

/// Maximum number of plans that are requested from the robot's position; after that, the promotion is dropped.
const MOST_PLANS: u32 = 3;
/// Maximum distance that the robot may drive back to the start of the plan that takes over, metres.
const MOST_BACK_M: f64 = 3.0;

/// Whether the planner in shadow has been ordered to take over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Promotion {
    No,
    /// Take over as soon as possible; `n_plans` is the number of plans requested from the robot's position so far.
    Ordered {
        n_plans: u32,
    },
}

impl Mission {
    /// Orders the planner in shadow to take over as soon as its plan can be run from the robot's position. If the robot
    /// is already close to that plan, the planner takes over in this tick. As with any change of planner, a hold that
    /// would have ended automatically now ends only by order.
    pub(in crate::engine) fn order_promotion(&mut self) {
        self.stay_held();
        if let Some(shadow) = &mut self.shadow {
            shadow.promotion = Promotion::Ordered { n_plans: 0 };
        }
    }

    /// Cancels the promotion because a different planner was chosen.
    pub(in crate::engine) fn cancel_promotion(&mut self) {
        if let Some(shadow) = &mut self.shadow {
            shadow.promotion = Promotion::No;
        }
    }

    /// Promotes the planner in shadow if that has been ordered and the planner is able to take over.
    pub(in crate::engine) fn promote_if_due(&mut self) {
        let is_ordered = |shadow: &&Shadow| shadow.promotion != Promotion::No;
        let Some(shadow) = self.shadow.as_ref().filter(is_ordered) else { return };
        // The operator does not expect a planner to take over long after the order.
        let refusal = self.standing().allows(&Order::Promote).err().map(|why| why.to_string());
        let barred = || shadow.worker.info.as_ref().and_then(|info| self.barred(info));
        if let Some(why) = refusal.or_else(barred) {
            return self.refuse_promotion(why);
        }
        if !shadow.may_take_over(self.known.tick) {
            return;
        }
        let here = self.known.position();
        let Some(rest) = shadow.rest_from(here, &self.known.trail) else { return self.promote_later() };
        let reason = Reason::Swap { from: self.driving.id().to_owned() };
        let asked = AskedPlan { from_anchor: shadow.from_anchor, ..AskedPlan::from_here(reason, here) };
        let mut evaluated = self.known.evaluate(None, shadow.worker.id(), &asked, rest);
        match evaluated.objection.take() {
            None => self.promote(evaluated),
            Some(objection) if objection.by_tether && self.known.may_try_from_anchor(&asked) => {
                let due = Due::from_anchor(asked.reason);
                self.shadow.iter_mut().for_each(|shadow| shadow.course.due = Some(due.clone()));
            }
            Some(objection) => self.refuse_promotion(objection.message),
        }
    }

    /// The robot is not on the shadow's plan. Requests one more plan, unless too many have been requested already.
    fn promote_later(&mut self) {
        match &mut self.shadow {
            Some(Shadow { promotion: Promotion::Ordered { n_plans }, course, .. })
                if *n_plans < MOST_PLANS =>
            {
                *n_plans += 1;
                course.want_plan(Reason::Swap { from: self.driving.id().to_owned() });
            }
            _ => self.refuse_promotion(
                "whenever a plan is ready, the robot has already left the place where it begins; HOLD first"
                    .into(),
            ),
        }
    }

    fn refuse_promotion(&mut self, why: String) {
        if let Some(shadow) = &mut self.shadow {
            shadow.promotion = Promotion::No;
            let planner = shadow.worker.id().to_owned();
            self.happened.push(EventKind::PromotionRefused { planner, why });
        }
    }

    fn promote(&mut self, evaluated: Evaluated) {
        let Some(Shadow { mut worker, course, tally, .. }) = self.shadow.take() else { return };
        let planner = worker.id().to_owned();
        self.reject_preparing(&format!("planner {planner} was promoted from shadow"));
        worker.before = self.driving.worker.seen().cloned();
        if let Some(pending) = worker.pending.as_mut().filter(|pending| pending.kind != PendingKind::Snapshot)
        {
            pending.kind = PendingKind::StepInShadow;
        }
        // A hold caused by the previous planner no longer has a reason.
        let is_held = matches!(self.known.phase, Phase::Held(_));
        let prepare = if is_held { Prepare::Plan } else { Prepare::No };
        self.happened.push(EventKind::Promoted { planner, tally });
        self.take_over(Driving::with_plan(worker, course.found_since, prepare), Said::default(), evaluated);
    }
}

impl Shadow {
    /// Whether the planner has a plan and owes no overdue answer.
    fn may_take_over(&self, tick: u64) -> bool {
        let owes = self.worker.pending.as_ref().is_some_and(|pending| pending.tick + 1 < tick);
        self.course.has_plan() && !owes
    }

    /// The rest of the planner's plan from the robot's position, with the points of the path driven so far; `None` if the
    /// plan is too far away.
    pub(super) fn rest_from(&self, here: Point, trail: &[Point]) -> Option<Plan> {
        let Some(route) = self.route() else { return Some(self.plan.clone()) };
        let since_asked = trail.get(self.n_flown.saturating_sub(1)..).unwrap_or_default();
        let approach = if self.is_near(here) { vec![here] } else { self.approach(here, since_asked)? };
        Some(rest_of(&self.plan, route.along_m(), &approach))
    }

    /// The path back to a plan that the robot moved away from while the plan was being made. In tasks in which lanes are
    /// followed exactly, the path leads back to the plan. In other tasks, planners find their own way back to their path.
    fn approach(&self, here: Point, since_asked: &[Point]) -> Option<Vec<Point>> {
        let back = || since_asked.iter().rev().copied();
        let n_back = back().position(|flown| self.is_near(flown))?;
        let way: Vec<Point> = std::iter::once(here).chain(back().take(n_back + 1)).collect();
        let is_short = polyline::length_m(&way) <= MOST_BACK_M;
        is_short.then(|| if matches!(self.task, Task::Cover(_)) { way } else { vec![here] })
    }
}
