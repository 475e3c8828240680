//! The plan of a planner, and the way along it.

use super::{
    known::Known,
    rules::{CutsRule, Solids},
};
use crate::{
    task::Task,
    tether::{Tether, return_path_ends},
};
use geometry::PathFollower;
use planner_api::{Plan, Reason};
use world::{ObstacleMap, Point, Shape};

/// The plan that a planner flies, or is to make.
#[derive(Clone, Default)]
pub(super) struct Course {
    /// The plan that is still to be made, or is being made.
    pub due: Option<Due>,
    /// Whether the last plan was for all that was left of the task.
    pub is_whole: bool,
    /// Its plan, for tasks that do not follow it by themselves.
    pub follower: Option<PathFollower>,
    /// The lines that its plan never crosses.
    pub cuts: CutsRule,
    /// What was found since the plan was asked for that is being made.
    pub found_since: Vec<Shape>,
}

/// A plan that is wanted.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Due {
    /// Why.
    pub reason: Reason,
    /// Whether it is to begin at the anchor, after a return path: from here it was refused for the tether.
    pub from_anchor: bool,
}

impl Due {
    /// A plan from where the robot stands.
    pub(super) fn from_here(reason: Reason) -> Self {
        Self { reason, from_anchor: false }
    }

    /// A plan from the anchor, after one from where the robot stands was refused.
    pub(super) fn from_anchor(reason: Reason) -> Self {
        Self { reason, from_anchor: true }
    }
}

impl Course {
    /// Nothing is planned yet.
    pub(super) fn new(reason: Reason) -> Self {
        Self { due: Some(Due::from_here(reason)), ..Self::default() }
    }

    /// Whether there is a plan and no other is due.
    pub(super) fn has_plan(&self) -> bool {
        self.due.is_none()
    }

    /// Whether the plan is for all that was left of the task; one that is still to be made is thought to be.
    pub(super) fn is_whole(&self) -> bool {
        self.is_whole || self.due.is_some()
    }

    /// Wants another plan, unless one is wanted already.
    pub(super) fn want_plan(&mut self, reason: Reason) {
        self.due.get_or_insert(Due::from_here(reason));
    }

    /// Goes along a plan from now on.
    pub(super) fn take(&mut self, plan: &Plan) {
        (self.due, self.is_whole) = (None, plan.complete);
        self.follower = (!plan.path.is_empty()).then(|| PathFollower::new(plan.path.clone()));
    }

    /// Goes on along the plan to where the robot is.
    pub(super) fn advance(&mut self, here: Point, map: &ObstacleMap) {
        if let Some(plan) = &mut self.follower {
            plan.advance(here, |at| map.clearance_m(at) >= 0.0);
        }
    }

    /// Watches the cuts of a plan that the robot flies from here.
    pub(super) fn keep_to_cuts(&mut self, plan: &Plan, known: &Known) {
        let anchor = known.tether.as_ref().map(Tether::anchor);
        let lines = if anchor.is_some() { plan.cuts.as_slice() } else { &[] };
        let from = anchor.map_or(0, |anchor| return_path_ends(plan, anchor));
        let boundary = &known.chart.world().boundary;
        let solids = Solids { boundary, map: known.chart.map(), room_m: known.config.room_m() };
        self.cuts = CutsRule::new(lines, plan.path.get(from).copied(), known.position(), &solids);
    }

    /// What was found while a plan was being made may stand in the way of a task: then another one is due at once.
    pub(super) fn doubt_fresh_plan(&mut self, task: &Task, room_m: f64) {
        let found = std::mem::take(&mut self.found_since);
        if found.iter().any(|shape| task.is_in_the_way(shape, room_m)) {
            self.want_plan(Reason::MapChanged);
        }
    }

    /// A robot that has come off the plan across a cut needs another plan, from the tether as it lies: whether it has.
    pub(super) fn has_strayed(&mut self, known: &Known) -> bool {
        let is_lost = known.locator.is_lost();
        let strays = !is_lost && self.cuts.update(known.position(), known.config.limits.radius_m);
        let has_strayed = strays && self.has_plan();
        if has_strayed {
            self.want_plan(Reason::MapChanged);
            self.cuts.clear();
        }
        has_strayed
    }

    /// What was found may stand beside the rest of the plan and yet in the way of its tether: then another plan is due.
    pub(super) fn doubt_for_tether(&mut self, known: &Known) {
        let Some(tether) = known.tether.as_ref().filter(|tether| !tether.flies_uncertified()) else { return };
        let Some(rest) = known.task.lanes_left().filter(|_| self.has_plan()) else { return };
        if !tether.bears(rest, known.chart.world(), known.task_ends_at_anchor()) {
            self.want_plan(Reason::MapChanged);
        }
    }
}
