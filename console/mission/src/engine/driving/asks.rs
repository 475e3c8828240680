//! The next ask to the active planner.

use super::{
    super::{course::Due, known::Known, requests::under_way, worker::PendingKind, workers::Workers},
    Driving, Prepare,
};
use crate::{
    ask::{Ask, Awaits, What},
    phase::Phase,
};
use planner_api::Reason;

/// Interval between snapshots of the private state, seconds.
const SAVE_EVERY_S: f64 = 1.0;

impl Driving {
    /// The next ask to this planner. No command is requested while the robot stands still for a planner that is to take
    /// over.
    pub(in crate::engine) fn next_ask(
        &mut self,
        known: &mut Known,
        workers: &mut Workers,
        waits_for_other: bool,
    ) -> Option<Ask> {
        if self.worker.pending.is_some() || matches!(known.phase, Phase::Ended(_)) {
            return None;
        }
        let is_running = known.follows_planner();
        if !self.worker.is_ready() {
            return (is_running || self.prepare > Prepare::No).then(|| self.open(known, workers));
        }
        if let Some(choice) = self.reconfigure.take() {
            let parameters = choice.parameters.clone();
            let kind = PendingKind::Reconfigure(choice);
            return self.worker.ask(known.tick, kind, What::Reconfigure(parameters));
        }
        if self.snapshot_due {
            return self.ask_for_snapshot(known);
        }
        if let Some(due) = &self.course.due {
            if !is_running && self.prepare < Prepare::Plan && !self.is_seen_plan_outdated(known) {
                return None;
            }
            let keep = self.keep.clone().or_else(|| under_way(&known.task, &due.reason));
            let plan = known.plan_ask(due, known.trail.len(), keep);
            self.course.found_since.clear();
            return self.worker.ask_for_plan(known.tick, plan);
        }
        if !is_running || self.stepped_at == Some(known.tick) {
            return None;
        }
        if self.is_snapshot_due(known) {
            return self.ask_for_snapshot(known);
        }
        if waits_for_other || !known.knows_medium() { None } else { self.ask_for_step(known) }
    }

    fn open(&mut self, known: &Known, workers: &mut Workers) -> Ask {
        if self.worker.info.is_some() {
            self.course.due = Some(Due::from_here(Reason::Recover));
        }
        self.saved_at_s = None;
        self.worker.open(known, workers)
    }

    fn is_snapshot_due(&self, known: &Known) -> bool {
        let is_due = |saved_at_s: f64| known.now_s() - saved_at_s >= SAVE_EVERY_S;
        self.worker.info.as_ref().is_some_and(|info| info.snapshots) && self.saved_at_s.is_some_and(is_due)
    }

    fn ask_for_snapshot(&mut self, known: &Known) -> Option<Ask> {
        (self.snapshot_due, self.saved_at_s) = (false, Some(known.now_s()));
        self.worker.ask(known.tick, PendingKind::Snapshot, What::Snapshot)
    }

    fn ask_for_step(&mut self, known: &mut Known) -> Option<Ask> {
        known.keep_trail();
        self.course.advance(known.position(), known.chart.map());
        let step = known.step_ask(&known.task, self.course.follower.as_ref());
        self.stepped_at = Some(known.tick);
        self.worker.ask(known.tick, PendingKind::Step { usable: true }, What::Step(Box::new(step)))
    }

    /// The answer from this planner that the mission would like to have before the tick ends.
    pub(in crate::engine) fn awaits(&self, known: &Known) -> Option<Awaits> {
        self.worker.pending.as_ref()?;
        Some(if !known.follows_planner() {
            Awaits::Candidate
        } else if self.worker.is_being_prepared() {
            Awaits::Work
        } else {
            Awaits::Step
        })
    }
}
