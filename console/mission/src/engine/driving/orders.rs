//! Effects of orders on the active planner: its first plan, new parameter values, and its successor.

use super::{
    super::{
        known::Known,
        planning::Objection,
        worker::{Pending, PendingKind},
    },
    Driving, Prepare,
};
use crate::{
    phase::Phase,
    plan_id::{PlanId, PlanSeen},
    planner::PlannerChoice,
    standing::Readiness,
};
use planner_api::Plan;

impl Driving {
    /// The latest change of live parameters that the planner has not answered yet.
    pub(in crate::engine) fn newest_change(&self) -> Option<&PlannerChoice> {
        let asked = match &self.worker.pending {
            Some(Pending { kind: PendingKind::Reconfigure(choice), .. }) => Some(choice),
            _ => None,
        };
        self.reconfigure.as_ref().or(asked)
    }

    /// Whether a choice names this planner and changes only values of live parameters. Such a change needs no new plan.
    /// Resetting a value to its default does not qualify, because planners receive only explicit values.
    pub(in crate::engine) fn takes_live(&self, choice: &PlannerChoice) -> bool {
        let before = &self.worker.choice;
        let is_live = |key: &String| self.worker.info.as_ref().is_some_and(|info| info.has_live(key));
        let mut changed =
            choice.parameters.iter().filter(|(key, value)| before.parameters.get(*key) != Some(value));
        let keeps_all = before.parameters.keys().all(|key| choice.parameters.contains_key(key));
        choice.id == before.id
            && *choice != *before
            && self.is_flying()
            && self.newest_change().is_none()
            && keeps_all
            && changed.all(|(key, _)| is_live(key))
    }

    /// Whether the planner can take a new value of a parameter directly. A planner that is still being opened while the
    /// mission runs receives the value once it is open, and refuses the value if the parameter is unknown. During a hold,
    /// the planner is opened with the value.
    pub(in crate::engine) fn takes_value(&self, key: &str, known: &Known) -> bool {
        match &self.worker.info {
            Some(info) => info.has_live(key) && (self.worker.is_ready() || known.is_running()),
            None => known.is_running(),
        }
    }

    /// Whether the robot is held because this planner has no plan that may be run.
    pub(in crate::engine) fn has_failed(&self, known: &Known) -> bool {
        let is_blamed = matches!(&known.phase, Phase::Held(hold) if hold.by.blames_planner());
        is_blamed && !self.course.has_plan()
    }

    /// Whether a successor can take over the current state of this planner.
    pub(in crate::engine) fn can_hand_over_state(&self, successor: &str) -> bool {
        let snapshots = self.worker.info.as_ref().is_some_and(|info| info.snapshots);
        snapshots && self.worker.is_ready() && successor == self.id()
    }

    /// The plan with which a start would begin the mission.
    pub(in crate::engine) fn readiness(&self, known: &Known) -> Readiness<'_> {
        if !known.config.start_names_plan || known.config.task.is_survey() {
            return Readiness::Unseen;
        }
        if self.worker.is_being_prepared() || self.prepare > Prepare::No || self.newest_change().is_some() {
            return Readiness::Preparing;
        }
        match &self.first_plan {
            None => Readiness::NoPlan,
            Some(Err(why)) => Readiness::Failed(why),
            Some(Ok(plan)) if self.course.has_plan() => Readiness::Plan(*plan),
            // The plan is being made again, because something was found in its way.
            Some(Ok(_)) => Readiness::Preparing,
        }
    }

    /// Whether the plan that the operator saw before the start is no longer the one that will be run.
    pub(super) fn is_seen_plan_outdated(&self, known: &Known) -> bool {
        known.is_waiting() && matches!(self.first_plan, Some(Ok(_))) && !self.course.has_plan()
    }

    /// Records the plan that the operator sees before the start, or why there is none.
    pub(in crate::engine) fn show_first_plan(
        &mut self,
        plan: &Plan,
        objection: Option<&Objection>,
        known: &Known,
    ) {
        if !known.is_waiting() || !known.config.start_names_plan {
            return;
        }
        let Plan { path, legs, cuts, complete, .. } = plan;
        let seen = PlanSeen { path, legs, cuts, complete: *complete };
        let id = self.worker.info.as_ref().map(|info| PlanId::of(&self.worker.choice, info, seen));
        self.first_plan = match objection {
            None => id.map(Ok),
            Some(objection) => Some(Err(objection.message.clone())),
        };
    }
}
