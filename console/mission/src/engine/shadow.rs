//! A planner in shadow: it has its own worker, plan and way along it, commands beside the planner that drives, and moves
//! nothing. Its faults end it and nothing else.

mod answers;
mod promotion;

use super::{
    Mission,
    requests::AskedPlan,
    requests::under_way,
    slot::{PendingKind, PlanState, PlannerSlot},
};
use crate::{
    ask::{Ask, What},
    event::{EventKind, ShadowTally},
    planner::PlannerChoice,
    task::Task,
};
use geometry::PathFollower;
use planner_api::{Plan, Reason};
use world::Point;

/// A robot further from the shadow's plan than this has left it, metres.
const NEAR_PLAN_M: f64 = 0.5;
/// A planner whose plan the robot has left plans again, so often at most, seconds.
const PLAN_AGAIN_S: f64 = 10.0;

/// A planner in shadow.
#[derive(Clone)]
pub(super) struct Shadow {
    pub slot: PlannerSlot,
    /// How it does.
    pub tally: ShadowTally,
    /// The task along its own plan.
    pub task: Task,
    plan: Plan,
    /// Whether its plan begins at the anchor because one from where the robot was is refused for the tether.
    from_anchor: bool,
    /// How many points the path flown had when its plan was asked for.
    n_flown: usize,
    /// Mission time then, seconds.
    asked_at_s: f64,
    /// What it is asked in this tick depends on the readings alone, and on no other planner's answer.
    now: Now,
    /// Whether it is to take over.
    promotion: Promotion,
}

/// What a planner in shadow may be asked in a tick, as it stands when the tick begins.
#[derive(Debug, Clone, Copy, Default)]
struct Now {
    /// Whether the robot runs.
    is_running: bool,
    /// Whether there is anything to plan for: lanes are handed over once the planner that drives has some.
    may_plan: bool,
    /// How many points the path flown has.
    n_flown: usize,
}

/// Whether a planner in shadow is to take over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Promotion {
    No,
    /// As soon as it can; it was asked so often for a plan from where the robot is.
    Ordered {
        n_plans: u32,
    },
}

impl Mission {
    /// A planner is to fly in shadow, in place of the one that does.
    pub(super) fn begin_shadow(&mut self, choice: PlannerChoice) {
        self.drop_shadow();
        let from = self.active.choice.id.clone();
        self.shadow = Some(Shadow {
            slot: self.active.successor(choice, Reason::Swap { from }),
            tally: ShadowTally::default(),
            task: self.known.task.clone(),
            plan: Plan::default(),
            from_anchor: false,
            n_flown: self.known.trail.len(),
            asked_at_s: self.known.now_s(),
            now: Now::default(),
            promotion: Promotion::No,
        });
    }

    /// Closes the planner in shadow without a word.
    pub(super) fn drop_shadow(&mut self) {
        if let Some(mut shadow) = self.shadow.take() {
            self.workers.close(shadow.slot.leave_worker());
        }
    }

    /// No planner flies in shadow any more, by order.
    pub(super) fn end_shadow(&mut self) {
        if let Some(Shadow { slot, .. }) = &self.shadow {
            let (planner, why) = (slot.choice.id.clone(), "ended by operator".into());
            self.happened.push(EventKind::ShadowEnded { planner, why });
        }
        self.drop_shadow();
    }

    /// Follows the shadow's plan from where the robot is; lets the shadow take over if that was ordered.
    pub(super) fn lead_shadow(&mut self) {
        let Some(mut shadow) = self.shadow.take() else { return };
        let here = self.known.position();
        self.advance_shadow(&mut shadow, here);
        shadow.now = Now {
            is_running: self.known.is_running(),
            may_plan: !self.known.is_coverage() || self.known.task.lanes().is_some(),
            n_flown: self.known.trail.len(),
        };
        if shadow.now.is_running {
            shadow.task.wait(self.known.config.tick_s);
            let asked_s = self.known.now_s() - shadow.asked_at_s;
            if asked_s >= PLAN_AGAIN_S && !shadow.is_near(here) {
                shadow.want_plan(&self.active.choice.id);
            }
        }
        self.shadow = self.promote_if_due(shadow);
    }

    fn advance_shadow(&self, shadow: &mut Shadow, here: Point) {
        let (chart, map, room_m) = (&self.known.chart, self.known.chart.map(), self.known.config.room_m());
        shadow.task.advance(here, map, |at| chart.has_room(at, room_m));
        if let Some(plan) = &mut shadow.slot.follower {
            plan.advance(here, |at| map.clearance_m(at) >= 0.0);
        }
    }

    /// What is asked of the planner in shadow next.
    pub(super) fn ask_shadow(&mut self) -> Option<Ask> {
        let mut shadow = self.shadow.take_if(|shadow| shadow.slot.pending.is_none())?;
        let ask = self.ask_of_shadow(&mut shadow);
        self.shadow = Some(shadow);
        ask
    }

    fn ask_of_shadow(&mut self, shadow: &mut Shadow) -> Option<Ask> {
        let tick = self.known.tick;
        if !shadow.slot.is_ready {
            let (worker, site) = (self.workers.next(), self.known.chart.site());
            return Some(shadow.slot.open(worker, tick, site));
        }
        if let PlanState::Due { reason, from_anchor } = shadow.slot.plan.clone() {
            if !shadow.now.may_plan {
                return None;
            }
            let keep = under_way(&shadow.task, &reason);
            let (asked, ask) = self.known.plan_ask(reason, from_anchor, shadow.now.n_flown, keep);
            (shadow.n_flown, shadow.asked_at_s) = (shadow.now.n_flown, self.known.now_s());
            shadow.slot.found_since.clear();
            return shadow.slot.ask(tick, PendingKind::Plan(asked), What::Plan(Box::new(ask)));
        }
        if !shadow.now.is_running || shadow.slot.stepped_at == Some(tick) {
            return None;
        }
        shadow.slot.stepped_at = Some(tick);
        let step = self.known.step_ask(&shadow.task, shadow.slot.follower.as_ref());
        shadow.slot.ask(tick, PendingKind::Step { usable: true }, What::Step(Box::new(step)))
    }
}

impl Shadow {
    /// Progress along its own plan, if that has a path.
    fn route(&self) -> Option<&PathFollower> {
        self.task.lanes().or(self.slot.follower.as_ref())
    }

    /// Whether a place is at its plan; any is, if it has no path.
    fn is_near(&self, here: Point) -> bool {
        self.route().is_none_or(|route| route.cross_track_m(here) <= NEAR_PLAN_M)
    }

    /// Has it plan again, because the robot went another way.
    fn want_plan(&mut self, active: &str) {
        self.slot.want_plan(Reason::Swap { from: active.to_owned() });
    }

    /// Takes a plan for what is left of a task.
    fn take_plan(&mut self, plan: Plan, task: Task, asked: &AskedPlan) {
        self.task = task;
        self.task.take_plan(&plan);
        self.slot.plan = PlanState::Flying { is_whole: plan.complete };
        self.slot.follower = (!plan.path.is_empty()).then(|| PathFollower::new(plan.path.clone()));
        self.from_anchor = asked.from_anchor;
        self.plan = plan;
    }
}
