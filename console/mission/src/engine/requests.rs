//! The inputs that planners receive when they are asked for a plan or a command.

use super::{course::Due, known::Known};
use crate::{
    ask::{PlanAsk, StepAsk},
    task::Task,
};
use geometry::PathFollower;
use planner_api::{Drive, Plan, PoseEstimate, Reason};
use std::sync::Arc;
use world::{CoverageGrid, Point};

/// Distance ahead of the robot up to which a planner receives the targets and the plan, metres.
const AHEAD_M: f64 = 4.0;

/// The data that the mission keeps about a plan that is being made.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AskedPlan {
    pub reason: Reason,
    /// The return path before the plan; empty for a plan from the robot's position.
    pub return_path: Vec<Point>,
    /// Whether the plan begins at the anchor because the first plan was refused for the tether.
    pub from_anchor: bool,
    /// Whether the planner was asked to keep to its plan and to change it only where the map has changed.
    pub is_repair: bool,
    /// The robot's position at the time of the ask.
    pub here: Point,
}

impl AskedPlan {
    /// The data of a plan that begins at the robot's position and was not requested from the planner.
    pub(super) fn from_here(reason: Reason, here: Point) -> Self {
        Self { reason, return_path: Vec::new(), from_anchor: false, is_repair: false, here }
    }
}

impl Known {
    /// The inputs of a plan from the end of a return path, or from the robot's position.
    ///
    /// A caught cable is freed first, and a slack cable made taut. If a plan was refused because of the cable that is out, the planner is asked once
    /// more. This time the plan is to begin at the anchor, after a return along the cable; in this way, no planner has
    /// to know how the cable lies. The planner receives the first `n_flown` points of the path driven.
    pub(super) fn plan_ask(
        &self,
        Due { reason, from_anchor }: &Due,
        n_flown: usize,
        keep: Option<Plan>,
    ) -> (AskedPlan, PlanAsk) {
        let return_path =
            if *from_anchor { self.way_to_anchor() } else { self.way_out() }.unwrap_or_default();
        let here = self.locator.pose_estimate();
        let start = return_path.last().map_or(here, |home| PoseEstimate { position: *home, ..here });
        let previous: Vec<Point> = self.trail[..n_flown].iter().chain(&return_path).copied().collect();
        let is_repair = keep.is_some() && matches!(reason, Reason::MapChanged | Reason::Blocked);
        let ask = self.plan_from(start, previous, &self.floor.coverage, (reason.clone(), keep));
        let asked = AskedPlan::from_here(reason.clone(), here.position);
        let asked = AskedPlan { return_path, from_anchor: *from_anchor, is_repair, ..asked };
        (asked, ask)
    }

    /// The inputs of a plan for the task that remains at some place: the path from the start of the mission to that
    /// place, the floor scanned by then, the reason for the plan, and the plan to keep to.
    pub(super) fn plan_from(
        &self,
        start: PoseEstimate,
        previous: Vec<Point>,
        coverage: &CoverageGrid,
        (reason, under_way): (Reason, Option<Plan>),
    ) -> PlanAsk {
        let task = self.task.left(coverage, self.config.lane_m(), self.config.tether_limits());
        PlanAsk { reason, start, task, site: Arc::new(self.chart.site()), previous, under_way }
    }

    /// Whether to ask once more, this time from the anchor, for a plan that was refused because of the tether.
    pub(super) fn may_try_from_anchor(&self, asked: &AskedPlan) -> bool {
        asked.return_path.is_empty() && !asked.from_anchor && self.way_to_anchor().is_some()
    }

    /// The inputs of a command, at the current place along a task and a plan.
    pub(super) fn step_ask(&self, task: &Task, plan: Option<&PathFollower>) -> StepAsk {
        let pose = self.locator.pose_estimate();
        let w_rad_per_s = match self.last_drive {
            Drive::Twist { w_rad_per_s, .. } => w_rad_per_s,
            Drive::Velocity(_) => 0.0,
        };
        // In a task with lanes, the task itself tracks the progress.
        let path_ahead = match task {
            Task::Cover(_) => task.targets_ahead(AHEAD_M),
            Task::Goto(_) | Task::Follow { .. } | Task::Survey(_) => {
                plan.map_or(&[][..], |plan| plan.ahead(AHEAD_M))
            }
        };
        StepAsk {
            tick: self.tick,
            t_s: self.now_s(),
            dt_s: self.config.tick_s,
            pose,
            v_m_per_s: self.speed_m_per_s(),
            w_rad_per_s,
            target: task.target(),
            targets_ahead: task.targets_ahead(AHEAD_M).to_vec(),
            path_ahead: path_ahead.to_vec(),
            obstacles: self.chart.near(pose.position),
        }
    }
}

/// The rest of the current plan, if the same planner is asked to continue it with a change.
pub(super) fn under_way(task: &Task, reason: &Reason) -> Option<Plan> {
    let goes_on = matches!(reason, Reason::MapChanged | Reason::Blocked | Reason::Recover);
    goes_on.then(|| task.under_way()).flatten()
}
