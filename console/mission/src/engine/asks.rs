//! What is asked of the planners next.

use super::{
    Mission,
    driving::AHEAD_M,
    slot::{AskedPlan, PendingKind, PlanState, PlannerSlot, Prepare},
};
use crate::{
    ask::{Ask, Awaits, PlanAsk, StepAsk, What},
    phase::Phase,
    task::Task,
};
use geometry::PathFollower;
use planner_api::{Drive, Plan, PoseEstimate, Reason};
use std::sync::Arc;
use world::{CoverageGrid, Point};

/// Where a plan begins.
pub(super) struct Beginning<'a> {
    pub start: PoseEstimate,
    /// The way to there, from the start of the mission.
    pub previous: Vec<Point>,
    /// What has been scanned by then.
    pub coverage: &'a CoverageGrid,
}

/// Private state is saved this often, seconds.
const SAVE_EVERY_S: f64 = 1.0;

impl Mission {
    /// The next thing that is wanted of a planner, if anything is. To be called until it gives nothing, after
    /// [`Mission::sense`] and after every [`Mission::answer`].
    pub fn poll_ask(&mut self) -> Option<Ask> {
        self.workers
            .poll()
            .or_else(|| self.ask_active())
            .or_else(|| self.ask_candidate())
            .or_else(|| self.ask_shadow())
    }

    /// What the mission would like to have before the tick ends.
    pub fn awaits(&self) -> Awaits {
        let is_running = self.is_running();
        match &self.active.pending {
            Some(pending) if is_running => match pending.kind {
                PendingKind::Open | PendingKind::Plan(_) => Awaits::Work,
                PendingKind::Reconfigure(_)
                | PendingKind::Step { .. }
                | PendingKind::StepInShadow
                | PendingKind::Snapshot => Awaits::Step,
            },
            Some(_) => Awaits::Candidate,
            None => match self.candidate.as_ref().filter(|slot| slot.pending.is_some()) {
                Some(slot) if is_running && slot.robot_waits => Awaits::Work,
                Some(_) => Awaits::Candidate,
                None if self.shadow.as_ref().is_some_and(|shadow| shadow.slot.pending.is_some()) => {
                    Awaits::Shadow
                }
                None => Awaits::Nothing,
            },
        }
    }

    /// Whether a planner is being opened or is making a plan, whether or not the robot stands for it.
    pub fn is_preparing(&self) -> bool {
        let shadow = self.shadow.as_ref().map(|shadow| &shadow.slot);
        self.active.is_being_prepared()
            || self.candidate.as_ref().into_iter().chain(shadow).any(PlannerSlot::is_being_prepared)
    }

    fn ask_active(&mut self) -> Option<Ask> {
        let is_running = self.is_running();
        let slot = &self.active;
        if slot.pending.is_some() || matches!(self.phase, Phase::Ended(_)) {
            return None;
        }
        if !slot.is_ready {
            return (is_running || slot.prepare > Prepare::No).then(|| self.open_active());
        }
        if let Some(choice) = self.active.reconfigure.take() {
            let parameters = choice.parameters.clone();
            return self.ask_of_active(PendingKind::Reconfigure(choice), What::Reconfigure(parameters));
        }
        if self.active.snapshot_due {
            return self.ask_for_snapshot();
        }
        if let PlanState::Due { reason, from_anchor } = &self.active.plan {
            if !is_running && self.active.prepare < Prepare::Plan && !self.is_seen_plan_outdated() {
                return None;
            }
            let keep = self.active.keep.clone().or_else(|| under_way(&self.task, reason));
            let (kind, what) = self.plan_ask(reason.clone(), *from_anchor, self.trail.len(), keep);
            self.active.found_since.clear();
            return self.ask_of_active(kind, what);
        }
        if is_running && self.is_snapshot_due() {
            return self.ask_for_snapshot();
        }
        let robot_waits = self.candidate.as_ref().is_some_and(|slot| slot.robot_waits);
        let is_step_due =
            is_running && !robot_waits && self.knows_medium() && self.active.stepped_at != Some(self.tick);
        is_step_due.then(|| self.ask_for_step()).flatten()
    }

    fn ask_for_snapshot(&mut self) -> Option<Ask> {
        (self.active.snapshot_due, self.active.saved_at_s) = (false, Some(self.now_s()));
        self.ask_of_active(PendingKind::Snapshot, What::Snapshot)
    }

    fn open_active(&mut self) -> Ask {
        if self.active.info.is_some() {
            self.active.plan = PlanState::due(Reason::Recover);
        }
        let (worker, site) = (self.workers.next(), self.chart.site());
        self.active.open(worker, self.tick, site)
    }

    fn ask_of_active(&mut self, kind: PendingKind, what: What) -> Option<Ask> {
        self.active.ask(self.tick, kind, what)
    }

    fn ask_candidate(&mut self) -> Option<Ask> {
        let is_saving = self.active.snapshot_due
            || matches!(&self.active.pending, Some(pending) if pending.kind == PendingKind::Snapshot);
        let slot = self.candidate.as_mut().filter(|slot| slot.pending.is_none())?;
        if !slot.is_ready {
            if is_saving {
                return None;
            }
            if slot.choice.id == self.active.choice.id {
                slot.saved = self.active.saved;
            }
            let (worker, site) = (self.workers.next(), self.chart.site());
            return Some(slot.open(worker, self.tick, site));
        }
        let PlanState::Due { reason, from_anchor } = slot.plan.clone() else { return None };
        if slot.better.is_some() {
            return self.ask_for_better_plan();
        }
        let keep = slot.keep.clone();
        let (kind, what) = self.plan_ask(reason, from_anchor, self.trail.len(), keep);
        let slot = self.candidate.as_mut()?;
        slot.found_since.clear();
        slot.ask(self.tick, kind, what)
    }

    fn is_snapshot_due(&self) -> bool {
        let slot = &self.active;
        let snapshots = slot.info.as_ref().is_some_and(|info| info.snapshots);
        snapshots
            && slot.stepped_at != Some(self.tick)
            && slot.saved_at_s.is_some_and(|saved_at_s| self.now_s() - saved_at_s >= SAVE_EVERY_S)
    }

    /// The inputs of a plan from the end of a return path, or from where the robot stands.
    ///
    /// A cable that is caught is freed first. A plan that was refused because of the cable out there is asked for once
    /// more from the anchor, after a way back along the cable: no planner has to know how the cable lies. Planners are given
    /// of the first `n_flown` points of the path flown.
    pub(super) fn plan_ask(
        &self,
        reason: Reason,
        from_anchor: bool,
        n_flown: usize,
        keep: Option<Plan>,
    ) -> (PendingKind, What) {
        let return_path = if from_anchor { self.way_to_anchor() } else { self.way_out() }.unwrap_or_default();
        let here = self.locator.pose_estimate();
        let start = return_path.last().map_or(here, |home| PoseEstimate { position: *home, ..here });
        let previous: Vec<Point> = self.trail[..n_flown].iter().chain(&return_path).copied().collect();
        let is_repair = keep.is_some() && matches!(reason, Reason::MapChanged | Reason::Blocked);
        let beginning = Beginning { start, previous, coverage: &self.floor.coverage };
        let what = What::Plan(Box::new(self.plan_from(beginning, reason.clone(), keep)));
        let asked =
            AskedPlan { return_path, from_anchor, is_repair, ..AskedPlan::from_here(reason, here.position) };
        (PendingKind::Plan(asked), what)
    }

    /// The inputs of a plan for what is left of the task.
    pub(super) fn plan_from(
        &self,
        Beginning { start, previous, coverage }: Beginning<'_>,
        reason: Reason,
        under_way: Option<Plan>,
    ) -> PlanAsk {
        let task = self.task.left(coverage, self.config.lane_m(), self.config.tether_limits());
        PlanAsk { reason, start, task, site: Arc::new(self.chart.site()), previous, under_way }
    }

    fn ask_for_step(&mut self) -> Option<Ask> {
        let here = self.locator.position();
        self.keep_trail();
        if let Some(plan) = &mut self.active.follower {
            let map = self.chart.map();
            plan.advance(here, |at| map.clearance_m(at) >= 0.0);
        }
        let step = self.step_ask(&self.task, self.active.follower.as_ref());
        self.active.stepped_at = Some(self.tick);
        self.ask_of_active(PendingKind::Step { usable: true }, What::Step(Box::new(step)))
    }

    /// The inputs of a command on the way along a task and a plan.
    pub(super) fn step_ask(&self, task: &Task, plan: Option<&PathFollower>) -> StepAsk {
        let pose = self.locator.pose_estimate();
        let w_rad_per_s = match self.happened.last_drive {
            Drive::Twist { w_rad_per_s, .. } => w_rad_per_s,
            Drive::Velocity(_) => 0.0,
        };
        // Lanes are followed by the task itself, which knows how far it is.
        let path_ahead = match task {
            Task::Cover(_) => task.targets_ahead(AHEAD_M),
            Task::Goto(_) | Task::Follow { .. } => plan.map_or(&[][..], |plan| plan.ahead(AHEAD_M)),
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

/// What is left of a plan that goes on being flown with a change, for the same planner.
pub(super) fn under_way(task: &Task, reason: &Reason) -> Option<Plan> {
    let goes_on = matches!(reason, Reason::MapChanged | Reason::Blocked | Reason::Recover);
    goes_on.then(|| task.under_way()).flatten()
}
