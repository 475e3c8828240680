//! What the answers of a planner do that is being prepared to take over.

use super::{
    Mission,
    answers::mismatch,
    known::Known,
    planning::Evaluated,
    requests::AskedPlan,
    slot::{Pending, PendingKind, PlanState, PlannerSlot},
};
use crate::{
    ask::{Answer, AskId, Given, Said},
    event::EventKind,
    task::Task,
};
use planner_api::Plan;

/// A candidate whose plan begins further from the robot than this plans again, metres.
pub(super) const NEAR_PLAN_M: f64 = 0.5;
/// It keeps to that plan if the robot has gone no further, metres: more floor would be scanned twice.
const MOST_GONE_M: f64 = 3.0;

impl Mission {
    /// Takes an answer of the planner that is being prepared; gives it back unless it has taken over or is closed.
    pub(super) fn answer_candidate(
        &mut self,
        mut slot: PlannerSlot,
        pending: Pending,
        Answer { ask, result, said }: Answer,
    ) -> Option<PlannerSlot> {
        match (pending.kind, result.and_then(|given| self.checked(&slot, given))) {
            (PendingKind::Open, Ok(Given::Opened(info))) => {
                self.happened.pass_on(said, &slot.choice.id);
                (slot.info, slot.is_ready) = (Some((*info).clone()), true);
                self.happened.push(EventKind::PlannerPrepared { ask, choice: slot.choice.clone(), info });
                Some(slot)
            }
            (PendingKind::Plan(_), Ok(Given::Plan(plan))) if slot.better.is_some() => {
                self.better_plan_arrived(slot, ask, plan, said)
            }
            (PendingKind::Plan(asked), Ok(Given::Plan(plan))) => {
                self.candidate_planned(slot, ask, asked, plan, said)
            }
            (_, result) => {
                let fault = result.err().unwrap_or_else(|| mismatch(&slot.choice.id));
                self.happened.pass_on(said, &slot.choice.id);
                if slot.better.is_some() {
                    self.better_plan_failed(slot, ask, fault);
                    return None;
                }
                let message = fault.message.clone();
                self.note_fault(ask, fault, slot.info.as_ref().map(|info| info.sha256.clone()));
                self.reject(slot, message);
                None
            }
        }
    }

    fn candidate_planned(
        &mut self,
        mut slot: PlannerSlot,
        ask: AskId,
        asked: AskedPlan,
        plan: Plan,
        said: Said,
    ) -> Option<PlannerSlot> {
        let id = slot.choice.id.clone();
        let gone_m = (self.known.position() - asked.here).norm();
        if gone_m > NEAR_PLAN_M {
            // The robot went on meanwhile. It plans again from here, and this time the robot waits for it.
            self.happened.pass_on(said, &id);
            let is_kept = gone_m <= MOST_GONE_M && self.known.is_coverage();
            // The journal repeats what the planner is asked next.
            let from_here = AskedPlan::from_here(asked.reason, asked.here);
            let planned = is_kept.then(|| Box::new(Known::planned(Some(ask), &id, &from_here, &plan)));
            self.happened.push(EventKind::Discarded { ask, plan: planned });
            slot.robot_waits = true;
            slot.keep = is_kept.then_some(Plan { cost: 0.0, ..plan });
            return Some(slot);
        }
        let Evaluated { plan, events, objection } = self.known.evaluate(Some(ask), &id, &asked, plan);
        if objection.is_none() {
            self.promote(slot);
            self.happened.pass_on(said, &id);
            self.happened.extend(events);
            self.take_plan(&plan);
            self.plan_is_there();
            return None;
        }
        self.happened.pass_on(said, &id);
        self.happened.extend(events);
        match objection {
            Some(objection) if !(objection.by_tether && self.known.may_try_from_anchor(&asked)) => {
                self.reject(slot, objection.message);
                None
            }
            _ => {
                slot.plan = PlanState::Due { reason: asked.reason, from_anchor: true };
                Some(slot)
            }
        }
    }

    /// The planner that was being prepared takes over.
    pub(super) fn promote(&mut self, slot: PlannerSlot) {
        let from = slot.before.as_ref().map(|before| before.id.clone());
        let (choice, info) = (slot.choice.clone(), slot.info.clone());
        self.replace_active(slot);
        if let Some(info) = info {
            self.happened.push(EventKind::PlannerChosen { ask: None, choice, info: Box::new(info), from });
        }
    }

    pub(super) fn reject(&mut self, mut slot: PlannerSlot, why: String) {
        self.workers.close(slot.leave_worker());
        self.happened.push(EventKind::PlannerRejected { planner: slot.choice.id, why });
    }
}
