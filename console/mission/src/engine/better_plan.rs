//! After a repair the planner is asked, in a second worker, for a plan for all that is left, while the robot flies on.
//!
//! It is asked as a candidate, which has no plan to keep to, from a place ahead on the plan that is flown: what is scanned up to
//! there counts as scanned, and the cable lies as it will lie there. A plan that is better by more than a change is worth is
//! offered, or taken, when the robot comes to that place; whatever changes the plan that is flown before drops it.

use super::{
    Mission,
    known::Known,
    planning::Evaluated,
    requests::AskedPlan,
    requests::Beginning,
    slot::{PendingKind, PlanState, PlannerSlot},
};
use crate::{
    ask::{Ask, AskId, Said, What},
    config::BetterPlan,
    event::{Effort, EventKind},
    planner::Fault,
    task::{Joint, Task, rest_of},
};
use geometry::PathFollower;
use planner_api::{Plan, PoseEstimate, Reason};
use world::{CoverageGrid, Point, Tool};

/// After a find the robot flies on for so long before it is asked for, seconds: what is found often lies in groups, and its
/// outline is corrected while the robot passes.
const SETTLE_S: f64 = 20.0;
/// It begins so far ahead at least, seconds of driving: time to plan, and for an operator to decide ...
const LEAD_S: f64 = 60.0;
/// ... and so far as a share of what is left of the plan: in a large tank both take longer.
const LEAD_SHARE: f64 = 0.05;
/// Less than this is not worth another plan, seconds of driving: 2 % of it and the half minute below are a seventh of it.
const WORTH_S: f64 = 300.0;
/// A change is worth it if it saves more than this, seconds: what an operator needs to look at it ...
const CHANGE_S: f64 = 30.0;
/// ... and this share of the rest: so much longer than planned is the way driven, after finds that nobody foresees.
const CHANGE_SHARE: f64 = 0.02;
/// Two plans scan the same if they leave the same up to this share of what is left to scan: cells count by their centres, so that two
/// plans of other lanes differ by single cells.
const SAME_FLOOR_SHARE: f64 = 0.0005;
/// The robot is at the place where the plan begins, metres along its way.
const AT_JOINT_M: f64 = 0.05;

/// A plan for all that is left, from a place on the plan that is flown.
#[derive(Clone, Default)]
pub(super) struct Better {
    /// From where on; `None` until it is asked for.
    joint: Option<Joint>,
    /// The plan, if it is better.
    offer: Option<Offer>,
    /// Whether it was ordered to be taken.
    is_ordered: bool,
}

#[cfg(test)]
impl Better {
    /// Where it begins.
    pub(super) fn begins(&self) -> Option<Point> {
        self.joint.map(|joint| joint.at)
    }
}

/// A plan that is better.
#[derive(Clone)]
struct Offer {
    plan: Plan,
    flown: Effort,
    better: Effort,
}

impl Mission {
    /// A repaired plan is flown: another one is looked for, if the mission wants any.
    pub(super) fn want_better_plan(&mut self) {
        let wanted = self.known.config.wants_better_plans() && self.known.is_coverage();
        self.better_plan_due_s = wanted.then(|| self.known.now_s() + SETTLE_S);
    }

    /// The map has changed: what is being made is out of date, and what is due waits until the map is settled.
    pub(super) fn postpone_better_plan(&mut self) {
        let is_under_way = self.better().is_some();
        self.drop_better_plan("the map has changed");
        if is_under_way || self.better_plan_due_s.is_some() {
            self.want_better_plan();
        }
    }

    /// Whether a better plan is offered and not taken yet.
    pub(super) fn has_offer(&self) -> bool {
        self.better().is_some_and(|better| better.offer.is_some() && !better.is_ordered)
    }

    /// The better plan is to be flown from where it begins.
    pub(super) fn order_better_plan(&mut self) {
        if let Some(better) = self.candidate.as_mut().and_then(|slot| slot.better.as_deref_mut()) {
            better.is_ordered = true;
        }
    }

    /// Gives up a better plan that is being made or offered, if there is one.
    pub(super) fn drop_better_plan(&mut self, why: &str) {
        if let Some(slot) = self.candidate.take_if(|slot| slot.better.is_some()) {
            self.close_better_plan(slot, why.into());
        }
    }

    fn close_better_plan(&mut self, mut slot: PlannerSlot, why: String) {
        self.workers.close(slot.leave_worker());
        self.happened.push(EventKind::BetterPlanDropped { planner: slot.choice.id, why });
    }

    fn better(&self) -> Option<&Better> {
        self.candidate.as_ref().and_then(|slot| slot.better.as_deref())
    }

    /// Begins to look for a better plan if one is due; takes it, or lets it go, where it begins.
    pub(super) fn lead_better_plan(&mut self) {
        if self.is_better_plan_due() {
            self.begin_better_plan();
        }
        let Some(better) = self.better() else { return };
        let (joint, is_ready) = (better.joint, better.offer.is_some());
        let is_taken = better.is_ordered || self.known.config.better_plan == BetterPlan::Take;
        if !self.active.has_plan() || !self.active.is_ready {
            return self.drop_better_plan("another plan is being made");
        }
        let along_m = self.known.task.lanes().map_or(0.0, PathFollower::along_m);
        if !self.known.is_running() || joint.is_none_or(|joint| along_m < joint.station_m - AT_JOINT_M) {
            return;
        }
        match self.candidate.take_if(|_| is_ready && is_taken) {
            Some(slot) => self.take_better_plan(slot),
            None if is_ready => self.drop_better_plan("the robot has passed the place where it begins"),
            None => self.drop_better_plan("it came after the robot had passed the place where it begins"),
        }
    }

    fn is_better_plan_due(&self) -> bool {
        let is_due = self.better_plan_due_s.is_some_and(|due_s| due_s <= self.known.now_s());
        let is_steady =
            self.active.is_ready && self.active.has_plan() && self.active.newest_change().is_none();
        is_due && is_steady && self.candidate.is_none() && self.known.is_running()
    }

    fn begin_better_plan(&mut self) {
        self.better_plan_due_s = None;
        if self.known.joint().is_some() {
            let mut slot = self.active.successor(self.active.choice.clone(), Reason::MapChanged);
            slot.better = Some(Box::default());
            self.candidate = Some(slot);
        }
    }
}

impl Known {
    /// Where a better plan would begin; `None` if too little is left from there on.
    fn joint(&self) -> Option<Joint> {
        let (Task::Cover(cover), Some(lanes)) = (&self.task, self.task.lanes()) else { return None };
        let v_m_per_s = self.config.limits.v_max_m_per_s;
        let left_m = lanes.length_m() - lanes.along_m();
        let joint = cover.joint((LEAD_S * v_m_per_s).max(LEAD_SHARE * left_m))?;
        (lanes.length_m() - joint.station_m >= WORTH_S * v_m_per_s).then_some(joint)
    }
}

impl Mission {
    /// Asks the candidate for a plan for all that will be left where it begins.
    pub(super) fn ask_for_better_plan(&mut self) -> Option<Ask> {
        let Some(joint) = self.known.joint() else {
            self.drop_better_plan("too little is left of the plan that is flown");
            return None;
        };
        let Task::Cover(cover) = &self.known.task else { return None };
        let way = cover.way_to(&joint);
        let coverage = self.known.coverage_after(&way);
        let heading_rad = way.windows(2).next_back().map(|pair| pair[1] - pair[0]).map(|w| w.y.atan2(w.x));
        let here = self.known.locator.pose_estimate();
        let start =
            PoseEstimate { position: joint.at, heading_rad: heading_rad.unwrap_or(here.heading_rad), ..here };
        let previous = self.known.trail.iter().chain(&way).copied().collect();
        let beginning = Beginning { start, previous, coverage: &coverage };
        let ask = self.known.plan_from(beginning, Reason::MapChanged, None);
        let asked = AskedPlan::from_here(Reason::MapChanged, here.position);
        let slot = self.candidate.as_mut()?;
        slot.better = Some(Box::new(Better { joint: Some(joint), ..Better::default() }));
        slot.ask(self.known.tick, PendingKind::Plan(asked), What::Plan(Box::new(ask)))
    }
}

impl Known {
    /// What will have been scanned after some way.
    fn coverage_after(&self, way: &[Point]) -> CoverageGrid {
        let mut coverage = self.floor.coverage.clone();
        Tool::along(way, |from, to| coverage.mark(self.config.tool(), from, to));
        coverage
    }
}

impl Mission {
    /// Judges a plan for all that is left; gives the candidate back if it is offered.
    pub(super) fn better_plan_arrived(
        &mut self,
        mut slot: PlannerSlot,
        ask: AskId,
        plan: Plan,
        said: Said,
    ) -> Option<PlannerSlot> {
        let planner = slot.choice.id.clone();
        self.happened.pass_on(said, &planner);
        let joint = slot.better.as_ref().and_then(|better| better.joint);
        let (Task::Cover(cover), Some(joint)) = (&self.known.task, joint) else { return None };
        let way = cover.way_to(&joint);
        let rest = cover.path_from(&joint);
        // The turn at the joint counts, too.
        let before = &way[way.len().saturating_sub(2)..way.len().saturating_sub(1)];
        let effort = |path: &[Point]| Effort::of(&[before, path].concat(), &self.known.config.limits);
        let (flown, better) = (effort(&rest), effort(&plan.path));
        let objection = self.known.objection_to_better(&way, &rest, (flown, better), &plan);
        self.happened.push(EventKind::BetterPlanned {
            ask,
            planner,
            path: plan.path.clone(),
            complete: plan.complete,
            legs: plan.legs.clone(),
            cuts: plan.cuts.clone(),
            flown,
            better,
            objection: objection.clone(),
        });
        if objection.is_some() {
            self.workers.close(slot.leave_worker());
            return None;
        }
        slot.plan = PlanState::Flying { is_whole: plan.complete };
        let offer = Some(Offer { plan, flown, better });
        slot.better = Some(Box::new(Better { joint: Some(joint), offer, is_ordered: false }));
        Some(slot)
    }
}

impl Known {
    /// Why a plan after some way is not offered in place of a path: for what it saves, for the floor that it scans, or for the
    /// tether.
    fn objection_to_better(
        &self,
        way: &[Point],
        rest: &[Point],
        (flown, better): (Effort, Effort),
        plan: &Plan,
    ) -> Option<String> {
        let (saves_s, worth_s) = (flown.time_s - better.time_s, CHANGE_S + CHANGE_SHARE * flown.time_s);
        if saves_s <= worth_s {
            let [flown_min, better_min, worth_min] = [flown.time_s, better.time_s, worth_s].map(|s| s / 60.0);
            return Some(format!(
                "{better_min:.1} min instead of {flown_min:.1}; a change is worth {worth_min:.1} min"
            ));
        }
        let coverage = self.coverage_after(way);
        let cell_m2 = coverage.floor().cell_m2();
        let same = SAME_FLOOR_SHARE * self.task.floor_left(&coverage).len() as f64;
        let [left, as_now] = [&plan.path[..], rest].map(|path| {
            let mut coverage = coverage.clone();
            Tool::along(path, |from, to| coverage.mark(self.config.tool(), from, to));
            self.task.floor_left(&coverage).len()
        });
        let less = left as f64 - as_now as f64;
        if less > same {
            let missed_m2 = less * cell_m2;
            return Some(format!("it saves {} but scans {missed_m2:.2} m² less", better.saving(&flown)));
        }
        let certificate = self
            .tether
            .as_ref()
            .map(|tether| tether.certify_after(way, plan, self.chart.world(), self.task_ends_at_anchor()))?;
        let why = || format!("it is not safe for the tether: {}", certificate.reasons.join("; "));
        (!certificate.certified).then(why)
    }
}

impl Mission {
    /// The planner failed while it made a better plan: nobody is harmed, so it counts against nobody.
    pub(super) fn better_plan_failed(&mut self, slot: PlannerSlot, ask: AskId, fault: Fault) {
        let why = fault.message.clone();
        self.happened.push(EventKind::PlannerFailed { ask: Some(ask), fault });
        self.close_better_plan(slot, why);
    }

    /// The robot is where the better plan begins.
    fn take_better_plan(&mut self, mut slot: PlannerSlot) {
        let planner = slot.choice.id.clone();
        let Some(Offer { plan, flown, better }) = slot.better.take().and_then(|better| better.offer) else {
            return;
        };
        let here = self.known.position();
        let asked = AskedPlan::from_here(Reason::MapChanged, here);
        let Evaluated { plan, events, objection } =
            self.known.evaluate(None, &planner, &asked, rest_of(&plan, 0.0, &[here]));
        if let Some(objection) = objection {
            return self.close_better_plan(slot, objection.message);
        }
        self.happened.push(EventKind::BetterPlanTaken { planner, flown, better });
        self.promote(slot);
        self.left = None;
        self.happened.extend(events);
        self.take_plan(&plan);
    }
}
