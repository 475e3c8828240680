//! A planner in shadow takes over: in one tick, with its plan from where the robot is then, and without a hold.

use super::{
    super::{
        Mission,
        planning::Evaluated,
        requests::AskedPlan,
        slot::{PendingKind, PlanState, Prepare},
    },
    Promotion, Shadow,
};
use crate::{
    event::EventKind,
    order::Order,
    phase::Phase,
    standing::Standing,
    task::{Task, rest_of},
};
use planner_api::{Plan, Reason};
use world::{Point, polyline};

/// It is asked so often for a plan from where the robot is; then the order is given up.
const MOST_PLANS: u32 = 3;
/// The robot goes back so far at most to where the plan that takes over begins, metres.
const MOST_BACK_M: f64 = 3.0;

impl Mission {
    /// The planner in shadow is to take over as soon as its plan flies from where the robot is: in this tick, if the robot is
    /// at its plan. A hold that was to end by itself ends by an order now, as for any change of planners.
    pub(in crate::engine) fn order_promotion(&mut self) {
        self.stay_held();
        if let Some(shadow) = &mut self.shadow {
            shadow.promotion = Promotion::Ordered { n_plans: 0 };
        }
    }

    /// The planner in shadow is not to take over: another one was chosen.
    pub(in crate::engine) fn cancel_promotion(&mut self) {
        if let Some(shadow) = &mut self.shadow {
            shadow.promotion = Promotion::No;
        }
    }

    /// Lets the shadow take over if it was ordered to and can; gives it back if not.
    pub(super) fn promote_if_due(&mut self, mut shadow: Shadow) -> Option<Shadow> {
        let Promotion::Ordered { n_plans } = shadow.promotion else { return Some(shadow) };
        // Nobody expects another planner to take over long after the order.
        let refusal = self.standing_of(&shadow).allows(&Order::Promote).err().map(|why| why.to_string());
        let barred = || shadow.slot.info.as_ref().and_then(|info| self.barred(info));
        if let Some(why) = refusal.or_else(barred) {
            self.refuse_promotion(&mut shadow, why);
            return Some(shadow);
        }
        if !shadow.may_take_over(self.known.tick) {
            return Some(shadow);
        }
        let from = self.active.choice.id.clone();
        let Some(rest) = shadow.rest_from(self.known.position(), &self.known.trail) else {
            if n_plans == MOST_PLANS {
                self.refuse_promotion(
                    &mut shadow,
                    "the robot leaves its plans before they are made; HOLD first".into(),
                );
            } else {
                shadow.promotion = Promotion::Ordered { n_plans: n_plans + 1 };
                shadow.want_plan(&from);
            }
            return Some(shadow);
        };
        let here = self.known.position();
        let reason = Reason::Swap { from };
        let asked = AskedPlan { from_anchor: shadow.from_anchor, ..AskedPlan::from_here(reason, here) };
        let evaluated = self.known.evaluate(None, &shadow.slot.choice.id, &asked, rest);
        match &evaluated.objection {
            None => {
                self.take_over(shadow, evaluated);
                return None;
            }
            Some(objection) if objection.by_tether && self.known.may_try_from_anchor(&asked) => {
                shadow.slot.plan = PlanState::Due { reason: asked.reason, from_anchor: true };
            }
            Some(objection) => self.refuse_promotion(&mut shadow, objection.message.clone()),
        }
        Some(shadow)
    }

    /// What decides about orders while this planner flies in shadow.
    fn standing_of(&self, shadow: &Shadow) -> Standing<'_> {
        Standing { shadow: Some(shadow.tally), ..self.standing() }
    }

    fn refuse_promotion(&mut self, shadow: &mut Shadow, why: String) {
        shadow.promotion = Promotion::No;
        self.happened.push(EventKind::PromotionRefused { planner: shadow.slot.choice.id.clone(), why });
    }

    fn take_over(
        &mut self,
        Shadow { mut slot, tally, .. }: Shadow,
        Evaluated { plan, events, .. }: Evaluated,
    ) {
        let planner = slot.choice.id.clone();
        self.drop_better_plan("another planner drives");
        if let Some(candidate) = self.candidate.take() {
            self.reject(candidate, format!("planner {planner} was promoted from shadow"));
        }
        slot.before = self.active.known().cloned();
        if let Some(pending) = &mut slot.pending {
            pending.kind = PendingKind::StepInShadow;
        }
        // A hold that blames the planner before has lost its reason.
        slot.prepare = if matches!(self.known.phase, Phase::Held(_)) { Prepare::Plan } else { Prepare::No };
        self.happened.push(EventKind::Promoted { planner, tally });
        self.promote(slot);
        self.happened.extend(events);
        self.take_plan(&plan);
        self.plan_is_there();
    }
}

impl Shadow {
    /// Whether it has a plan, and no answer of it is overdue.
    fn may_take_over(&self, tick: u64) -> bool {
        let owes = self.slot.pending.as_ref().is_some_and(|pending| pending.tick + 1 < tick);
        self.slot.has_plan() && !owes
    }

    /// What is left of its plan from where the robot is, which has flown this way. `None` if the plan is too far off.
    pub(super) fn rest_from(&self, here: Point, trail: &[Point]) -> Option<Plan> {
        let Some(route) = self.route() else { return Some(self.plan.clone()) };
        let since_asked = trail.get(self.n_flown.saturating_sub(1)..).unwrap_or_default();
        let approach = if self.is_near(here) { vec![here] } else { self.approach(here, since_asked)? };
        Some(rest_of(&self.plan, route.along_m(), &approach))
    }

    /// The way to a plan from which the robot went away while it was made: back to it where lanes are followed exactly;
    /// to a point, or along preset ones, planners find their own way from beside their path.
    fn approach(&self, here: Point, since_asked: &[Point]) -> Option<Vec<Point>> {
        let back = || since_asked.iter().rev().copied();
        let n_back = back().position(|flown| self.is_near(flown))?;
        let way: Vec<Point> = std::iter::once(here).chain(back().take(n_back + 1)).collect();
        let is_short = polyline::length_m(&way) <= MOST_BACK_M;
        is_short.then(|| if matches!(self.task, Task::Cover(_)) { way } else { vec![here] })
    }
}
