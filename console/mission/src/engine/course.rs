//! The plan of a planner, and the progress along it.

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

/// The plan of a planner: in use, or still to be made.
#[derive(Clone, Default)]
pub(super) struct Course {
    /// The plan that is still due or being made.
    pub due: Option<Due>,
    /// Whether the last plan covered the whole rest of the task.
    pub is_whole: bool,
    /// Progress along the plan, for tasks that do not track it themselves.
    pub follower: Option<PathFollower>,
    /// The lines that the plan never crosses.
    pub cuts: CutsRule,
    /// The place where the plan begins.
    pub begins: Option<Point>,
    /// Obstacles found since the plan that is now being made was requested.
    pub found_since: Vec<Shape>,
}

/// A plan that is due.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Due {
    /// The reason for the plan.
    pub reason: Reason,
    /// Whether the plan begins at the anchor, after a return path, because the plan from the robot's position was refused
    /// for the tether.
    pub from_anchor: bool,
}

impl Due {
    /// A plan from the robot's position.
    pub(super) fn from_here(reason: Reason) -> Self {
        Self { reason, from_anchor: false }
    }

    /// A plan from the anchor, after the plan from the robot's position was refused.
    pub(super) fn from_anchor(reason: Reason) -> Self {
        Self { reason, from_anchor: true }
    }
}

impl Course {
    /// A course without a plan yet.
    pub(super) fn new(reason: Reason) -> Self {
        Self { due: Some(Due::from_here(reason)), ..Self::default() }
    }

    /// Whether there is a plan and no new plan is due.
    pub(super) fn has_plan(&self) -> bool {
        self.due.is_none()
    }

    /// Whether the plan covers the whole rest of the task; assumed to be true while a plan is due.
    pub(super) fn is_whole(&self) -> bool {
        self.is_whole || self.due.is_some()
    }

    /// Requests a new plan, unless one is already due.
    pub(super) fn want_plan(&mut self, reason: Reason) {
        self.due.get_or_insert(Due::from_here(reason));
    }

    /// Switches to a plan.
    pub(super) fn take(&mut self, plan: &Plan) {
        (self.due, self.is_whole, self.begins) = (None, plan.complete, plan.path.first().copied());
        self.follower = (!plan.path.is_empty()).then(|| PathFollower::new(plan.path.clone()));
    }

    /// For a real vehicle that has not been started: its distance from the beginning of its plan, metres.
    pub(super) fn first_from_m(&self, known: &Known) -> Option<f64> {
        let at = self.begins.filter(|_| known.config.live && known.is_waiting())?;
        Some((known.position() - at).norm())
    }

    /// Advances along the plan to the robot's position.
    pub(super) fn advance(&mut self, here: Point, map: &ObstacleMap) {
        if let Some(plan) = &mut self.follower {
            plan.advance(here, |at| map.clearance_m(at) >= 0.0);
        }
    }

    /// Starts watching the cuts of a plan that begins here.
    pub(super) fn keep_to_cuts(&mut self, plan: &Plan, known: &Known) {
        let anchor = known.tether.as_ref().map(Tether::anchor);
        let lines = if anchor.is_some() { plan.cuts.as_slice() } else { &[] };
        let from = anchor.map_or(0, |anchor| return_path_ends(plan, anchor));
        let boundary = &known.chart.world().boundary;
        let solids = Solids { boundary, map: known.chart.map(), room_m: known.config.room_m() };
        self.cuts = CutsRule::new(lines, plan.path.get(from).copied(), known.position(), &solids);
    }

    /// Requests a new plan immediately if obstacles that were found while the plan was being made block the task.
    pub(super) fn doubt_fresh_plan(&mut self, task: &Task, room_m: f64) {
        let found = std::mem::take(&mut self.found_since);
        if found.iter().any(|shape| task.is_in_the_way(shape, room_m)) {
            self.want_plan(Reason::MapChanged);
        }
    }

    /// Whether the robot has left its plan by crossing a cut. If so, requests a new plan for the tether as it lies now.
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

    /// Requests a new plan if found obstacles obstruct the tether on the rest of the plan, even if they do not block
    /// the path.
    pub(super) fn doubt_for_tether(&mut self, known: &Known) {
        let Some(tether) = known.tether.as_ref().filter(|tether| !tether.flies_uncertified()) else { return };
        let Some(rest) = known.task.lanes_left().filter(|_| self.has_plan()) else { return };
        if !tether.bears(rest, known.chart.world(), known.task_ends_at_anchor()) {
            self.want_plan(Reason::MapChanged);
        }
    }
}
