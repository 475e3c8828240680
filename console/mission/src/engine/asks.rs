//! What is asked of the planners next.

use super::{
    Mission,
    requests::under_way,
    slot::{PendingKind, PlanState, PlannerSlot, Prepare},
};
use crate::{
    ask::{Ask, Awaits, What},
    phase::Phase,
};
use planner_api::Reason;

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
        let is_running = self.known.is_running();
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
        let is_running = self.known.is_running();
        let slot = &self.active;
        if slot.pending.is_some() || matches!(self.known.phase, Phase::Ended(_)) {
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
            let keep = self.active.keep.clone().or_else(|| under_way(&self.known.task, reason));
            let (asked, ask) =
                self.known.plan_ask(reason.clone(), *from_anchor, self.known.trail.len(), keep);
            self.active.found_since.clear();
            return self.ask_of_active(PendingKind::Plan(asked), What::Plan(Box::new(ask)));
        }
        if is_running && self.is_snapshot_due() {
            return self.ask_for_snapshot();
        }
        let robot_waits = self.candidate.as_ref().is_some_and(|slot| slot.robot_waits);
        let is_step_due = is_running
            && !robot_waits
            && self.known.knows_medium()
            && self.active.stepped_at != Some(self.known.tick);
        is_step_due.then(|| self.ask_for_step()).flatten()
    }

    fn ask_for_snapshot(&mut self) -> Option<Ask> {
        (self.active.snapshot_due, self.active.saved_at_s) = (false, Some(self.known.now_s()));
        self.ask_of_active(PendingKind::Snapshot, What::Snapshot)
    }

    fn open_active(&mut self) -> Ask {
        if self.active.info.is_some() {
            self.active.plan = PlanState::due(Reason::Recover);
        }
        let (worker, site) = (self.workers.next(), self.known.chart.site());
        self.active.open(worker, self.known.tick, site)
    }

    fn ask_of_active(&mut self, kind: PendingKind, what: What) -> Option<Ask> {
        self.active.ask(self.known.tick, kind, what)
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
            let (worker, site) = (self.workers.next(), self.known.chart.site());
            return Some(slot.open(worker, self.known.tick, site));
        }
        let PlanState::Due { reason, from_anchor } = slot.plan.clone() else { return None };
        if slot.better.is_some() {
            return self.ask_for_better_plan();
        }
        let keep = slot.keep.clone();
        let (asked, ask) = self.known.plan_ask(reason, from_anchor, self.known.trail.len(), keep);
        let slot = self.candidate.as_mut()?;
        slot.found_since.clear();
        slot.ask(self.known.tick, PendingKind::Plan(asked), What::Plan(Box::new(ask)))
    }

    fn is_snapshot_due(&self) -> bool {
        let slot = &self.active;
        let snapshots = slot.info.as_ref().is_some_and(|info| info.snapshots);
        snapshots
            && slot.stepped_at != Some(self.known.tick)
            && slot.saved_at_s.is_some_and(|saved_at_s| self.known.now_s() - saved_at_s >= SAVE_EVERY_S)
    }

    fn ask_for_step(&mut self) -> Option<Ask> {
        let here = self.known.position();
        self.known.keep_trail();
        if let Some(plan) = &mut self.active.follower {
            let map = self.known.chart.map();
            plan.advance(here, |at| map.clearance_m(at) >= 0.0);
        }
        let step = self.known.step_ask(&self.known.task, self.active.follower.as_ref());
        self.active.stepped_at = Some(self.known.tick);
        self.ask_of_active(PendingKind::Step { usable: true }, What::Step(Box::new(step)))
    }
}
